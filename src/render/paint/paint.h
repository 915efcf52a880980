// Private to src/render: what the passes that make a picture's colours keep between frames.
#ifndef ORL_RENDER_PAINT_H
#define ORL_RENDER_PAINT_H

#include "render/paint/edges.h"
#include "render/paint/fill.h"
#include "render/paint/gather.h"
#include "render/paint/guess.h"
#include "render/paint/soft_layer.h"

struct paint {
    struct gather gather;      // parameters of the photographs in use
    struct fill fill;
    struct soft_layer soft;
    struct edges edges;
    struct guess guess;
    struct orl_tex *trusted;   // RGBA32F, radiance: weight * confidence, weight, blur; else NULL
    struct orl_tex *states[2]; // RGBA32F, state of a combination between sweeps, and output of
                               // a filter; else NULL
};

enum orl_result orl_paint_init(struct orl_gpu *gpu, size_t photo_count, struct paint *paint) ORL_CHECK_RESULT;
void orl_paint_finish(struct orl_gpu *gpu, struct paint *paint);
// Makes the targets fit what this frame runs. Does nothing if all is there.
enum orl_result orl_paint_resize(const struct frame *frame) ORL_CHECK_RESULT;

#endif
