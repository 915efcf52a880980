// Private to src/render: the painter of Goldluecke 2003, section 3.
#ifndef ORL_RENDER_BILLBOARDS_H
#define ORL_RENDER_BILLBOARDS_H

#include "core/order.h"
#include "oriel/scene.h"

// Sorts `count` photographs by the arc between their optical axis and the view's, radians, the least first.
void orl_rank_by_axis(const struct orl_scene *scene, const struct orl_view *view,
                      const size_t *photos, size_t count, struct orl_ranked *ranked);

// What is drawn of a voxel.
struct billboard {
    float centre[3];  // the view's camera frame
    uint32_t photos;  // places among the ranked ones of the first and, from bit 16 on, of the second photograph
    float second;     // weight of the second: 1 - alpha_k / (alpha_j + alpha_k); 0: there is none
    uint32_t voxel;   // its index
};
// Chooses the first two photographs of `ranked` that see all of a voxel, or where there is none a
// part of it. seen: two sets of `words` words, as in struct voxel_state. False: none sees it.
bool orl_billboard_choose(const struct orl_ranked *ranked, size_t count, const uint32_t *seen,
                          size_t words, struct billboard *out);

#endif
