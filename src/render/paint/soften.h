// Private to src/render: input of the blur on estimated depth, done by shaders/fill/compose.comp.
#ifndef ORL_RENDER_SOFTEN_H
#define ORL_RENDER_SOFTEN_H

#include "render/frame/frame.h"

struct soften {
    struct orl_tex *guesses; // mipmapped sums over 2x2 pixels of (colour, 1) on estimated depth
};

// The largest blur of a picture of this size, pixels.
// Allocates for pictures of this size. Does nothing if all that is asked for is there.
enum orl_result orl_soften_resize(struct orl_gpu *gpu, struct soften *soften, int width,
                                  int height);
void orl_soften_finish(struct orl_gpu *gpu, struct soften *soften);
// Makes the mipmaps. Painters that finish pixels have written the sums; for radiance they are made
// here.
void orl_soften_prepare(const struct frame *frame);

#endif
