// Private to src/render: the cones of silhouettes, which voxels are carved with on the device.
#ifndef ORL_RENDER_CONES_H
#define ORL_RENDER_CONES_H

#include "oriel/gpu.h"
#include "scene/hull.h"

// One camera's partial hull.
struct cone {
    struct orl_view view;
    struct orl_image distance; // F32 x1: signed distance to the outline, pixels, positive outside
    bool open;                 // the subject leaves the picture
};

struct cones {
    struct cone *all; // owned
    size_t count;
    struct orl_hull_bounds bounds; // of what all of them have in common
};

// Work of the processor alone, which any thread may do. Errors are those of orl_hull_find_bounds.
enum orl_result orl_cones_make(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                               size_t count, struct cones *cones) ORL_CHECK_RESULT;
void orl_cones_finish(struct cones *cones);
// Asks the device for the intersection of all cones in a cube of side^3 voxels, x fastest: at each
// voxel's centre the signed distance to the nearest cone, F32, scene units, negative inside. The
// caller destroys *field. Does not wait for the device.
enum orl_result orl_cones_carve(struct orl_gpu *gpu, const struct cones *cones, int side,
                                struct orl_buf **field) ORL_CHECK_RESULT;

#endif
