// Private to src/render: what single pixels show wrongly: specks, and depth edges that are not antialiased.
#ifndef ORL_RENDER_EDGES_H
#define ORL_RENDER_EDGES_H

#include "render/frame/frame.h"

struct edges {
    struct orl_buf *list;  // shaders/edges/edge_list.glsl
    int width, height;     // of the pictures that it is made for
    struct orl_tex *painted; // RG8, of each pixel: how much its best photograph varies there; fourth root of light
};

// Allocates for pictures of this size. Does nothing if the size is unchanged.
enum orl_result orl_edges_resize(struct orl_gpu *gpu, struct edges *edges, int width, int height);
void orl_edges_finish(struct orl_gpu *gpu, struct edges *edges);
// Whether the painter keeps `painted`, and specks go.
bool orl_edges_find_specks(const struct frame *frame);
// Gives specks the colour of what surrounds them.
void orl_edges_remove_specks(const struct frame *frame);
// Averages the finished colours across depth discontinuities.
void orl_edges_antialias(const struct frame *frame);

#endif
