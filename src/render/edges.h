// Private to src/render: depth edges. Photographs tell where they are, and colours there are
// antialiased.
#ifndef ORL_RENDER_EDGES_H
#define ORL_RENDER_EDGES_H

#include "render/frame.h"

struct edges {
    struct orl_buf *list;  // shaders/edges/edge_list.glsl
    struct orl_tex *votes; // R32F, of listed pixels
};

// For pictures of this size; does nothing when they had it already.
enum orl_result orl_edges_resize(struct orl_gpu *gpu, struct edges *edges, int width, int height);
void orl_edges_finish(struct orl_gpu *gpu, struct edges *edges);
// Takes depth back from where it reaches past silhouettes; no normal is left there.
// `choice`: the dispatch of shaders/gather/choose.comp, which has run.
void orl_edges_cut(const struct frame *frame, const struct orl_dispatch *choice);
// Averages the finished colours across the steps of depth.
void orl_edges_antialias(const struct frame *frame);

#endif
