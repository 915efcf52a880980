#include "render/paint/paint.h"

#include "shared/render_blocks.h"

enum {
    LIST = 2,     // storage binding of shaders/edges/edge_list.glsl
    WORKERS = 4096, // invocations that work on the list: the host does not know how long it is
};

void orl_edges_finish(struct orl_gpu *gpu, struct edges *edges)
{
    orl_buf_destroy(gpu, &edges->list);
    orl_tex_destroy(gpu, &edges->painted);
}

enum orl_result orl_edges_resize(struct orl_gpu *gpu, struct edges *edges, int width, int height)
{
    // Room for every pixel, since the number of listed pixels is unknown.
    size_t bytes = 16 * (1 + (size_t)width * (size_t)height);
    size_t most = orl_gpu_caps(gpu)->max_storage_block;
    return orl_buf_fit(gpu, ORL_OWNER_FRAME, "pixels at edges", bytes < most ? bytes : most, 0, &edges->list);
}

bool orl_edges_find_specks(const struct frame *frame)
{
    return frame->finishes && frame->params->antialias == ORL_ANTIALIAS_ON &&
           frame->params->sampling == ORL_SAMPLING_BICUBIC;
}

// Lists pixels by `find`, which reads `from`, runs `change` over the list, and then over the picture with what it has
// written there.
static enum orl_result run(const struct frame *frame, const char *find, const char *change, const struct orl_tex *from)
{
    const bool half = frame->picture->params.format == GL_RGBA16F;
    const struct image_block block = {.image_size = {frame->surface.width, frame->surface.height},
                                      .footprint = (float)orl_frame_footprint(frame)};
    struct orl_dispatch d = {.prog = orl_prog_get(frame->gpu, find, NULL, NULL), ORL_PARAMS(block),
                             .bufs = {[LIST] = frame->paint->edges.list}, .images = {from, from},
                             // One invocation handles 2x2 pixels.
                             .size = {(frame->surface.width + 1) / 2, (frame->surface.height + 1) / 2}};
    orl_buf_write(frame->paint->edges.list, 0, sizeof(uint32_t), &(uint32_t){0});
    orl_gpu_dispatch(frame->gpu, &d);
    d.images[0] = frame->picture;
    d.size[0] = WORKERS;
    d.size[1] = 1;
    d.prog = orl_prog_get(frame->gpu, change, NULL, half ? "HALF" : NULL);
    orl_gpu_dispatch(frame->gpu, &d);
    d.prog = orl_prog_get(frame->gpu, change, NULL, half ? "WRITE 1\nHALF" : "WRITE");
    orl_gpu_dispatch(frame->gpu, &d);
    return ORL_OK;
}

enum orl_result orl_edges_remove_specks(const struct frame *frame)
{
    return run(frame, "edges/specks_find.comp", "edges/specks.comp", frame->paint->edges.painted);
}

enum orl_result orl_edges_antialias(const struct frame *frame)
{
    return run(frame, "edges/antialias_find.comp", "edges/antialias.comp", frame->surface.depth);
}
