// Private to src/render: depth edges. Their position is corrected from the photographs, and colours
// across them are antialiased.
#ifndef ORL_RENDER_EDGES_H
#define ORL_RENDER_EDGES_H

#include "render/frame.h"

struct edges {
    struct orl_buf *list;  // shaders/edges/edge_list.glsl
    struct orl_tex *votes; // R32F, for listed pixels
};

// Allocates for pictures of this size. Does nothing if the size is unchanged.
enum orl_result orl_edges_resize(struct orl_gpu *gpu, struct edges *edges, int width, int height);
void orl_edges_finish(struct orl_gpu *gpu, struct edges *edges);
// Removes foreground depth that reaches past silhouettes; the background depth takes its place,
// without a normal. `choice`: the dispatch of shaders/gather/choose.comp that has run.
void orl_edges_cut(const struct frame *frame, const struct orl_dispatch *choice);
// Averages the finished colours across depth discontinuities.
void orl_edges_antialias(const struct frame *frame);

#endif
