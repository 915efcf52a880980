// Private to src/render: guessed depth moves to where photographs do not see past it.
#ifndef ORL_RENDER_GUESS_H
#define ORL_RENDER_GUESS_H

#include "render/frame/frame.h"
#include "shared/render_blocks.h"

struct guess {
    struct orl_buf *costs, *sums;         // per cell and plane: shaders/guess/planes.glsl
    struct orl_tex *estimated, *picked;   // per cell, R32F: inverse depth; share of it
};

// Allocates for pictures of this size. Does nothing if the frame tries no depths.
enum orl_result orl_guess_resize(const struct frame *frame, struct guess *guess);
void orl_guess_finish(struct orl_gpu *gpu, struct guess *guess);
// True if this frame tries depths: the method asks for it, and the costs fit into a storage buffer.
bool orl_guess_applies(const struct frame *frame);
// Moves the estimated background depth to where few photographs see past it and the others agree,
// from the estimate to infinity. `choice`: the dispatch of shaders/gather/choose.comp, with the
// parameters `block`, that has run. It runs again for tiles with estimated depth, since other
// photographs see the new depths best.
void orl_guess_depth(const struct frame *frame, const struct orl_dispatch *choice,
                     const struct gather_block *block);

#endif
