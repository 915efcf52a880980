// Private to src/render: background depth and colour for pixels that nothing covers.
#ifndef ORL_RENDER_FILL_H
#define ORL_RENDER_FILL_H

#include "render/frame.h"
#include "shared/render_blocks.h"

enum { FILL_LEVELS_MAX = 17 };

struct fill {
    int width, height, levels;
    struct image_block block; // of its passes
    // value * weight, weight; level 0 has half the size
    struct orl_tex *level[FILL_LEVELS_MAX];
};

enum orl_result orl_fill_resize(struct orl_gpu *gpu, struct fill *fill, int width, int height);
void orl_fill_finish(struct orl_gpu *gpu, struct fill *fill);
// Guesses background depth, as negative values, where the surface has none; no farther than the
// scene's ground with fill=ground.
void orl_fill_depth(const struct frame *frame);
// Spreads the blended picture over fill->level[0]; of painters that finish pixels what that holds
// already, 2x2 pixels of colour, 1 summed. Of radiance what clips takes light from around it first.
void orl_fill_color(const struct frame *frame);

#endif
