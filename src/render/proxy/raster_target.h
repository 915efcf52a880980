// Private to src/render: the targets of proxies that the graphics pipeline draws, as struct
// proxy_kind asks for them. `state` is not read.
#ifndef ORL_RENDER_RASTER_TARGET_H
#define ORL_RENDER_RASTER_TARGET_H

#include "oriel/gpu.h"

struct raster_target {
    int width, height;
    struct orl_tex *depth, *normal; // of struct surface
    struct orl_tex *test;           // the depth test's own
};

enum orl_result orl_raster_target_resize(struct orl_gpu *gpu, const void *state, int width,
                                         int height, void **out);
void orl_raster_target_free(struct orl_gpu *gpu, void **handle);
size_t orl_raster_target_bytes(const void *state, int width, int height);

#endif
