// Private to src/render: what single pixels show wrongly: specks, and depth edges that are not antialiased.
#ifndef ORL_RENDER_EDGES_H
#define ORL_RENDER_EDGES_H

#include "render/frame/frame.h"

struct edges {
    struct orl_buf *list;  // shaders/edges/edge_list.glsl
    struct orl_tex *painted; // RG8, of each pixel: how much its best photograph varies there; fourth root of light
};

// Makes room for the pixels of pictures of this size.
enum orl_result orl_edges_resize(struct orl_gpu *gpu, struct edges *edges, int width, int height) ORL_CHECK_RESULT;
void orl_edges_finish(struct orl_gpu *gpu, struct edges *edges);
// Whether the painter keeps `painted`, and specks go.
bool orl_edges_find_specks(const struct frame *frame);
// Gives specks the colour of what surrounds them.
void orl_edges_remove_specks(const struct frame *frame);
// Averages the finished colours across depth discontinuities.
void orl_edges_antialias(const struct frame *frame);

#endif
