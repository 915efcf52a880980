// Private to src/hdr.
#ifndef ORL_HDR_INTERNAL_H
#define ORL_HDR_INTERNAL_H

#include "oriel/hdr.h"
#include "oriel/scene.h"

// --- a picture from each series, merged (series.c) ---

struct series {
    int number;              // series number, as in struct orl_photo
    size_t count;            // number of photographs in use
    float ev;                // their exposure, in stops above the scene's middle
    int response;            // of all of them, as in struct orl_photo
    bool *skip;              // per photograph: not of this series, or skipped for a view
};

struct series_set {
    struct orl_scene scene; // borrowed, except `photos`, whose gains are per series
    struct series *items;
    size_t count;
    float least_ev, most_ev; // of the series
    struct orl_renderer *renderer;
};

enum orl_result orl_series_init(struct orl_gpu *gpu, const struct orl_scene *scene,
                                const struct orl_hdr_params *params, struct series_set *set);
void orl_series_finish(struct series_set *set);
enum orl_result orl_series_draw(const struct orl_log *log, struct series_set *set,
                                const struct orl_hdr_params *params, const struct orl_view *view,
                                const bool *skip, struct orl_frame *frame);

// --- the public object (hdr.c) ---

struct orl_hdr {
    struct orl_gpu *gpu;
    const struct orl_scene *scene;
    struct orl_hdr_params params;
    struct orl_renderer *fused; // NULL: merge by series
    struct series_set series;
};

// Fills the colour of unknown pixels (known <= 0) from the pixels around them. The left and right
// borders are adjacent (around.c).
enum orl_result orl_fill_around(const struct orl_log *log, struct orl_image *color,
                                const struct orl_image *known);

#endif
