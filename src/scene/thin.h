// Points that only two photographs agree on, added where points of three or more are missing.
#ifndef ORL_SCENE_THIN_H
#define ORL_SCENE_THIN_H

#include "oriel/image.h"
#include "oriel/progress.h"
#include "oriel/camera.h"
#include "oriel/points.h"

struct orl_thin_params {
    float spacing;       // a thin point needs this much room, in its own radii, (0, 64]
    uint8_t photographs; // points of `thin` that more photographs agree on are left out
};
#define ORL_THIN_DEFAULTS .spacing = 1.0f, .photographs = 2

// Appends to `points` those points of `thin` that have no point of `points` within `spacing` times
// their radius. The radii of `thin` state its local density (orl_points_set_radii). Points of
// either cloud that are not usable are dropped. The order of points is kept, so the result is
// deterministic.
enum orl_result orl_points_add_thin(const struct orl_log *log, const struct orl_thin_params *params,
                                    struct orl_points *thin,
                                    struct orl_points *points) ORL_CHECK_RESULT;

// Counts free-space violations: adds one to seen_past[i] for each point that lies in front of the
// surface that this photograph sees, by more than `tolerance`, a fraction of depth, at the point's
// pixel, and by more than the depth of the point's own surface changes within a pixel. `depth` is z,
// 0: none, of any size with the view's aspect ratio.
void orl_points_count_seen_past(const struct orl_points *points, const struct orl_view *view,
                                const struct orl_image *depth, float tolerance,
                                uint16_t *seen_past);
// Removes a point when the number of photographs that see past it is at least half the number that
// agree on it. Points with an unknown number of photographs stay.
void orl_points_drop_seen_past(const uint16_t *seen_past, struct orl_points *points);

#endif
