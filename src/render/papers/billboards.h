// Private to src/render: the painter of Goldluecke 2003, section 3.
#ifndef ORL_RENDER_BILLBOARDS_H
#define ORL_RENDER_BILLBOARDS_H

#include "render/frame/method.h"
#include "oriel/scene.h"

// A photograph, and the arc between its optical axis and the view's.
struct ranked_photo {
    size_t photo;
    size_t row;   // its parameters on the device
    double angle; // radians
};
// Sorts `count` photographs by the arc, the least first; rows count as in `photos`.
void orl_rank_by_axis(const struct orl_scene *scene, const struct orl_view *view,
                      const size_t *photos, size_t count, struct ranked_photo *ranked);

// What is drawn of a voxel.
struct billboard {
    float centre[3];  // the view's camera frame
    uint32_t photos;  // rows of the first and, from bit 16 on, of the second photograph
    float second;     // weight of the second: 1 - alpha_k / (alpha_j + alpha_k); 0: there is none
    uint32_t voxel;   // its index
};
// Chooses the first two photographs of `ranked` that see all of a voxel, or where there is none a
// part of it. seen: two sets of `words` words, as in struct voxel_state. False: none sees it.
bool orl_billboard_choose(const struct ranked_photo *ranked, size_t count, const uint32_t *seen,
                          size_t words, struct billboard *out);

#endif
