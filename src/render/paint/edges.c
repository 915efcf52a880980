#include "render/paint/paint.h"

#include "shared/render_blocks.h"

enum {
    LIST = 2,     // storage binding of shaders/edges/edge_list.glsl
    GROUPS = 64,  // that work on the list: the host does not know how long it is
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
    return orl_make_room(gpu, "pixels at edges", bytes < most ? bytes : most, &edges->list);
}

// Runs `find` over all pixels to list some of them. `d` holds the rest of its dispatch, and is then
// turned into a dispatch over the list.
static void list(const struct frame *frame, struct orl_prog *find, struct orl_dispatch *d)
{
    orl_buf_write(frame->paint->edges.list, 0, sizeof(uint32_t), &(uint32_t){0});
    // One invocation handles 2x2 pixels.
    orl_pixel_groups((frame->surface.width + 1) / 2, (frame->surface.height + 1) / 2, d->groups);
    d->prog = find;
    d->bufs[LIST] = frame->paint->edges.list;
    d->barrier = GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                 GL_TEXTURE_UPDATE_BARRIER_BIT;
    orl_gpu_dispatch(frame->gpu, d);
    d->groups[0] = GROUPS;
    d->groups[1] = 1;
}

// Runs `file` over the list that is in `d`, and then over the picture with what it has written there.
static void apply(const struct frame *frame, const char *file, struct orl_dispatch d)
{
    bool half = frame->picture->params.format == GL_RGBA16F;
    d.images[0] = (struct orl_image_binding){frame->picture, 0, GL_READ_WRITE};
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
    struct orl_dispatch d = {.params = &block, .params_size = sizeof block,
                             .images = {{frame->paint->edges.painted, 0, GL_READ_ONLY},
                                        {frame->paint->edges.painted, 0, GL_READ_ONLY}}};
    list(frame, orl_prog_get(frame->gpu, "edges/specks_find.comp", NULL, NULL), &d);
    apply(frame, "edges/specks.comp", d);
    return ORL_OK;
}

enum orl_result orl_edges_antialias(const struct frame *frame)
{
    struct image_block block = {.image_size = {frame->surface.width, frame->surface.height},
                                .footprint = (float)orl_frame_footprint(frame)};
    struct orl_dispatch d = {.params = &block, .params_size = sizeof block,
                             .images = {{frame->surface.depth, 0, GL_READ_ONLY}}};
    list(frame, orl_prog_get(frame->gpu, "edges/antialias_find.comp", NULL, NULL), &d);
    apply(frame, "edges/antialias.comp", d);
    return ORL_OK;
}
