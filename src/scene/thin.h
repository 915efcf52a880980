// What two photographs agree on, added where three see nothing.
#ifndef ORL_SCENE_THIN_H
#define ORL_SCENE_THIN_H

#include "oriel/image.h"
#include "oriel/progress.h"
#include "oriel/camera.h"
#include "oriel/points.h"

struct orl_thin_params {
    float spacing;       // a thin point needs this much room, in its own radii, (0, 64]
    uint8_t photographs; // points of `thin` with more than this are not taken
};
#define ORL_THIN_DEFAULTS .spacing = 1.0f, .photographs = 2

// Appends to `points` those of `thin` that stand where `points` has nothing near: no point
// within `spacing` times their radius. thin's radii say how dense it is there
// (orl_points_set_radii). Points of either that are not usable are dropped. Points keep their order, so the result is the same on every run.
enum orl_result orl_points_add_thin(const struct orl_log *log, const struct orl_thin_params *params,
                                    struct orl_points *thin,
                                    struct orl_points *points) ORL_CHECK_RESULT;

// Adds one to seen_past[i] for the points that stand in front of what this photograph sees:
// its depth map has a surface farther by more than `tolerance`, a fraction of depth, at
// their pixel. `depth` is z, 0: none, of any size with the view's proportions.
void orl_points_count_seen_past(const struct orl_points *points, const struct orl_view *view,
                                const struct orl_image *depth, float tolerance,
                                uint16_t *seen_past);
// Removes the points that half as many photographs see past as agree on them, or more.
// Points without a number of photographs stay.
void orl_points_drop_seen_past(const uint16_t *seen_past, struct orl_points *points);

#endif
