// Private to src/render: depth edges, across which colours are antialiased.
#ifndef ORL_RENDER_EDGES_H
#define ORL_RENDER_EDGES_H

#include "render/frame/frame.h"

struct edges {
    struct orl_buf *list;  // shaders/edges/edge_list.glsl
    int width, height;     // of the pictures that it is made for
};

// Allocates for pictures of this size. Does nothing if the size is unchanged.
enum orl_result orl_edges_resize(struct orl_gpu *gpu, struct edges *edges, int width, int height);
void orl_edges_finish(struct orl_gpu *gpu, struct edges *edges);
// Averages the finished colours across depth discontinuities.
void orl_edges_antialias(const struct frame *frame);

#endif
