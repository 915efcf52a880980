// Private to src/render: the scene's soft splats (src/soft) in the frame's picture.
#ifndef ORL_RENDER_SOFT_LAYER_H
#define ORL_RENDER_SOFT_LAYER_H

#include "render/frame/frame.h"
#include "soft/soft_raster.h"

// Zero-initialised, it holds nothing: the splats are read with the first frame that shows them.
struct soft_layer {
    struct orl_soft_raster raster;
};

// True if the frame's picture shows soft splats.
bool orl_soft_layer_shows(const struct frame *frame);
// Mixes them into the finished picture. ORL_ERR_NOT_FOUND: the scene has none (oriel refine).
enum orl_result orl_soft_layer_mix(const struct frame *frame, struct soft_layer *layer) ORL_CHECK_RESULT;
void orl_soft_layer_finish(struct orl_gpu *gpu, struct soft_layer *layer);

#endif
