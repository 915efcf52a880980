// Private to src/render: background depth and colour for pixels that nothing covers, and input of the blur on
// estimated depth, done by shaders/fill/compose.comp.
#ifndef ORL_RENDER_FILL_H
#define ORL_RENDER_FILL_H

#include "render/frame/frame.h"
#include "shared/render_blocks.h"

enum { FILL_LEVELS_MAX = 17 };

struct fill {
    struct image_block block; // parameters of the passes
    int levels;               // of the picture
    // The pyramid: value * weight, weight. Level 0 has half the picture's size.
    struct orl_tex *level[FILL_LEVELS_MAX];
    struct orl_tex *guesses; // mipmapped sums over 2x2 pixels of (colour, 1) on estimated depth
};

// Makes the textures fit pictures of this size.
enum orl_result orl_fill_resize(struct orl_gpu *gpu, struct fill *fill, int width, int height) ORL_CHECK_RESULT;
void orl_fill_finish(struct orl_gpu *gpu, struct fill *fill);
// Writes the estimated background depth ("guess" in identifiers), as negative values, where the
// surface has none. With fill=ground it is no farther than the scene's ground.
void orl_fill_depth(const struct frame *frame);
// Completes the picture of a room where no photograph shows it.
void orl_fill_room(const struct frame *frame, struct orl_tex *room);
// Spreads the blended colours over fill->level[0]. Painters that finish pixels have already written
// sums over 2x2 pixels of (colour, 1) there. In radiance, clipped pixels first take the light
// around them. Before a room only colours of surfaces count.
void orl_fill_color(const struct frame *frame);
// Makes the mipmaps of fill->guesses. Painters that finish pixels have written the sums; for radiance they are
// made here.
void orl_fill_guesses(const struct frame *frame);

#endif
