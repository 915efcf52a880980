// Private to src/render: what the blur of guesses takes in; shaders/fill/compose.comp blurs.
#ifndef ORL_RENDER_SOFTEN_H
#define ORL_RENDER_SOFTEN_H

#include "render/frame.h"

struct soften {
    struct orl_tex *guesses; // mipmapped sums of colour on guessed depth: shaders/fill/compose.comp
};

// For pictures of this size; does nothing when they had it already.
enum orl_result orl_soften_resize(struct orl_gpu *gpu, struct soften *soften, int width,
                                  int height);
void orl_soften_finish(struct orl_gpu *gpu, struct soften *soften);
// Mipmaps of what is painted on guessed depth. Painters that finish pixels have written the sums;
// of radiance they are made here.
void orl_soften_prepare(const struct frame *frame);

#endif
