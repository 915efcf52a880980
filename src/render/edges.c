// Depth edges: photographs tell where they are, and colours there are antialiased.
#include <string.h>

#include "render/internal.h"

enum { LIST = 2 }; // storage binding of shaders/edges/edge_list.glsl

enum orl_result orl_edges_init(struct orl_gpu *gpu, struct edges *edges)
{
    memset(edges, 0, sizeof *edges);
    const struct {
        const char *file, *defines;
        size_t params_size;
        struct orl_prog **prog;
    } programs[] = {
        {"edges/silhouette_find.comp", NULL, sizeof(struct gather_block), &edges->find},
        {"edges/silhouette_judge.comp", NULL, sizeof(struct gather_block), &edges->judge},
        {"edges/silhouette_cut.comp", NULL, 0, &edges->cut},
        {"edges/antialias_find.comp", NULL, sizeof(struct image_block), &edges->find_steps},
        {"edges/antialias.comp", NULL, 0, &edges->average[0]},
        {"edges/antialias.comp", "HALF", 0, &edges->average[1]},
        {"edges/antialias.comp", "WRITE", 0, &edges->write[0]},
        {"edges/antialias.comp", "WRITE 1\nHALF", 0, &edges->write[1]},
    };
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(programs); i++)
        result = orl_prog_create(gpu, programs[i].file, programs[i].defines,
                                 programs[i].params_size, programs[i].prog);
    if (result != ORL_OK)
        orl_edges_finish(gpu, edges);
    return result;
}

void orl_edges_finish(struct orl_gpu *gpu, struct edges *edges)
{
    orl_prog_destroy(gpu, &edges->find);
    orl_prog_destroy(gpu, &edges->judge);
    orl_prog_destroy(gpu, &edges->cut);
    orl_prog_destroy(gpu, &edges->find_steps);
    for (int half = 0; half < 2; half++) {
        orl_prog_destroy(gpu, &edges->average[half]);
        orl_prog_destroy(gpu, &edges->write[half]);
    }
    orl_buf_destroy(gpu, &edges->list);
    orl_tex_destroy(gpu, &edges->votes);
}

enum orl_result orl_edges_resize(struct orl_gpu *gpu, struct edges *edges, int width, int height)
{
    const struct orl_tex *old = edges->votes;
    if (old && old->params.width == width && old->params.height == height)
        return ORL_OK;
    orl_tex_destroy(gpu, &edges->votes);
    orl_buf_destroy(gpu, &edges->list);
    // Room for every pixel: there is no telling.
    size_t bytes = 16 * (1 + (size_t)width * (size_t)height);
    size_t most = orl_gpu_caps(gpu)->max_storage_block;
    enum orl_result result = orl_buf_create(gpu, "pixels at edges", bytes < most ? bytes : most,
                                            NULL, &edges->list);
    if (result != ORL_OK)
        return result;
    return orl_tex_create(gpu, &(struct orl_tex_params){.width = width, .height = height,
                                                        .format = GL_R32F, .tag = "votes"},
                          &edges->votes);
}

// Runs `find` over all pixels, which lists some. The rest of its dispatch in `d`, which then
// is one over the list.
static void list(struct orl_gpu *gpu, const struct edges *edges, struct orl_prog *find,
                 struct orl_dispatch *d)
{
    static const uint32_t nothing[4] = {0, 1, 1, 0};
    orl_buf_write(edges->list, 0, sizeof nothing, nothing);
    d->prog = find;
    d->bufs[LIST].buf = edges->list;
    d->barrier = GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                 GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT;
    orl_gpu_dispatch(gpu, d);
    d->indirect = edges->list;
}

void orl_edges_cut(struct orl_gpu *gpu, const struct edges *edges,
                   const struct orl_dispatch *choice, const struct proxy_target *target)
{
    struct orl_dispatch d = *choice;
    orl_pass_begin(gpu, "silhouette");
    orl_pixel_groups((target->width + 1) / 2, (target->height + 1) / 2, d.groups);
    list(gpu, edges, edges->find, &d);
    orl_tex_clear(edges->votes, 0);
    d.prog = edges->judge;
    d.images[1] = (struct orl_image_binding){edges->votes, 0, GL_WRITE_ONLY};
    orl_gpu_dispatch(gpu, &d);
    d.prog = edges->cut;
    d.params = NULL;
    d.images[0].access = GL_WRITE_ONLY;
    d.images[1].access = GL_READ_ONLY;
    d.images[2] = (struct orl_image_binding){target->normal, 0, GL_WRITE_ONLY};
    orl_gpu_dispatch(gpu, &d);
    orl_pass_end(gpu);
}

void orl_edges_antialias(struct orl_gpu *gpu, const struct edges *edges,
                         const struct orl_tex *depth, struct orl_tex *color)
{
    int width = color->params.width, height = color->params.height;
    bool half = color->params.format == GL_RGBA16F;
    struct image_block block = {.area = {width, height}};
    struct orl_dispatch d = {.params = &block, .images = {{depth, 0, GL_READ_ONLY}}};
    orl_pixel_groups((width + 1) / 2, (height + 1) / 2, d.groups);
    orl_pass_begin(gpu, "antialias");
    list(gpu, edges, edges->find_steps, &d);
    d.params = NULL;
    d.images[0] = (struct orl_image_binding){color, 0, GL_READ_WRITE};
    d.prog = edges->average[half];
    orl_gpu_dispatch(gpu, &d);
    d.prog = edges->write[half];
    orl_gpu_dispatch(gpu, &d);
    orl_pass_end(gpu);
}
