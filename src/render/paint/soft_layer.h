// Private to src/render: the scene's soft splats (src/soft) in the frame's picture. Where the surface is wrong, a
// picture blended from photographs has its structure in wrong places. The splats show how much: what they show in those
// photographs, blended in the same way, then differs from what they show in the view.
#ifndef ORL_RENDER_SOFT_LAYER_H
#define ORL_RENDER_SOFT_LAYER_H

#include "render/frame/frame.h"
#include "soft/soft_raster.h"

// Zero-initialised, it holds nothing: the splats are read with the first frame that shows them.
struct soft_layer {
    bool shows; // the frame's picture shows them
    struct orl_soft_raster raster;
    // Owned, of the view's size, R16F: the luma of splats in photographs, blended, < 0: none; mipmapped, how far that
    // in the view differs.
    struct orl_tex *gathered, *differs;
};

// Makes the layer of a frame whose photographs are chosen ready, with the splats as each of them shows them. In a
// progressive frame it is one photograph, and while others lack it, the frame no longer shows the splats.
// ORL_ERR_NOT_FOUND: the scene has none (oriel refine).
enum orl_result orl_soft_layer_ready(struct frame *frame) ORL_CHECK_RESULT;
// Corrects the frame's picture.
enum orl_result orl_soft_layer_mix(const struct frame *frame) ORL_CHECK_RESULT;
// Keeps what the splats show in a photograph in a layer of a GL_R8 texture at least as large, but for its mip levels.
enum orl_result orl_soft_layer_keep(struct orl_gpu *gpu, struct orl_soft_raster *raster, const struct orl_view *view,
                                    struct orl_tex *slots, int slot) ORL_CHECK_RESULT;
void orl_soft_layer_finish(struct orl_gpu *gpu, struct soft_layer *layer);

#endif
