// Private to src/render: the targets of proxies that the graphics pipeline draws, as struct
// proxy_kind asks for them. `state` is not read.
#ifndef ORL_RENDER_RASTER_TARGET_H
#define ORL_RENDER_RASTER_TARGET_H

#include "render/frame/frame.h"

struct raster_target {
    struct surface surface;
    struct orl_tex *test; // the depth test's own
};

enum orl_result orl_raster_target_make(struct orl_gpu *gpu, const void *state, void *target);
void orl_raster_target_finish(struct orl_gpu *gpu, void *target);
size_t orl_raster_target_bytes(const void *state, int width, int height);

#endif
