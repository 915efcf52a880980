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

// Runs `find` over all pixels to list some of them. `d` holds the rest of its dispatch, and is then
// turned into a dispatch over the list.
static void list(const struct frame *frame, struct orl_prog *find, struct orl_dispatch *d)
{
    orl_buf_write(frame->paint->edges.list, 0, sizeof(uint32_t), &(uint32_t){0});
    // One invocation handles 2x2 pixels.
    d->size[0] = (frame->surface.width + 1) / 2;
    d->size[1] = (frame->surface.height + 1) / 2;
    d->prog = find;
    d->bufs[LIST] = frame->paint->edges.list;
    orl_gpu_dispatch(frame->gpu, d);
    d->size[0] = WORKERS;
    d->size[1] = 1;
}

// Runs `file` over the list that is in `d`, and then over the picture with what it has written there.
static void apply(const struct frame *frame, const char *file, struct orl_dispatch d)
{
    bool half = frame->picture->params.format == GL_RGBA16F;
    d.images[0] = frame->picture;
    d.prog = orl_prog_get(frame->gpu, file, NULL, half ? "HALF" : NULL);
    orl_gpu_dispatch(frame->gpu, &d);
    d.prog = orl_prog_get(frame->gpu, file, NULL, half ? "WRITE 1\nHALF" : "WRITE");
    orl_gpu_dispatch(frame->gpu, &d);
}

bool orl_edges_find_specks(const struct frame *frame)
{
    return frame->finishes && frame->params->antialias == ORL_ANTIALIAS_ON &&
           frame->params->sampling == ORL_SAMPLING_BICUBIC;
}

enum orl_result orl_edges_remove_specks(const struct frame *frame)
{
    struct image_block block = {.image_size = {frame->surface.width, frame->surface.height}};
    struct orl_dispatch d = {ORL_PARAMS(block),
                             .images = {frame->paint->edges.painted, frame->paint->edges.painted}};
    list(frame, orl_prog_get(frame->gpu, "edges/specks_find.comp", NULL, NULL), &d);
    apply(frame, "edges/specks.comp", d);
    return ORL_OK;
}

enum orl_result orl_edges_antialias(const struct frame *frame)
{
    struct image_block block = {.image_size = {frame->surface.width, frame->surface.height},
                                .footprint = (float)orl_frame_footprint(frame)};
    struct orl_dispatch d = {ORL_PARAMS(block), .images = {frame->surface.depth}};
    list(frame, orl_prog_get(frame->gpu, "edges/antialias_find.comp", NULL, NULL), &d);
    apply(frame, "edges/antialias.comp", d);
    return ORL_OK;
}
