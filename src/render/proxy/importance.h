// What each point contributes to pictures: of which pixels it is the nearest point.
#ifndef ORL_RENDER_IMPORTANCE_H
#define ORL_RENDER_IMPORTANCE_H

#include "oriel/render.h"

struct orl_importance;
// Uploads the scene's points. The gpu and the scene must outlive *out.
enum orl_result orl_importance_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                      struct orl_importance **out) ORL_CHECK_RESULT;
void orl_importance_destroy(struct orl_importance **importance);

// The points that win the pixels of a view, row by row.
struct orl_nearest_points {
    int width, height;
    uint32_t *point; // owned: index in scene->points; UINT32_MAX: none
    float *depth;    // owned: z of that point; INFINITY: none
};
// Splats all points into the view. Of points at the same depth one wins.
enum orl_result orl_importance_draw(struct orl_importance *importance,
                                    const struct orl_view *view,
                                    struct orl_nearest_points *nearest) ORL_CHECK_RESULT;
void orl_nearest_points_finish(struct orl_nearest_points *nearest);

#endif
