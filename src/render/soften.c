// What the blur of guesses takes in: shaders/fill/compose.comp blurs.
#include <string.h>

#include "render/internal.h"

enum orl_result orl_soften_init(struct orl_gpu *gpu, bool radiance, struct soften *soften)
{
    memset(soften, 0, sizeof *soften);
    return radiance ? orl_prog_create(gpu, "fill/fill_seed.comp", "SEED_GUESSES",
                                      sizeof(struct image_block), &soften->seed)
                    : ORL_OK;
}

void orl_soften_finish(struct orl_gpu *gpu, struct soften *soften)
{
    orl_prog_destroy(gpu, &soften->seed);
    orl_tex_destroy(gpu, &soften->guesses);
}

enum orl_result orl_soften_resize(struct orl_gpu *gpu, struct soften *soften, int width,
                                  int height)
{
    const struct orl_tex *old = soften->guesses;
    struct orl_tex_params params = {.width = (width + 1) / 2, .height = (height + 1) / 2,
                                    .levels = 1, .linear = true, .format = GL_RGBA32F,
                                    .tag = "guesses"};
    if (old && old->params.width == params.width && old->params.height == params.height)
        return ORL_OK;
    orl_tex_destroy(gpu, &soften->guesses);
    // A texel of the last level is as large as the largest blur, or all of the picture.
    int longer = width > height ? width : height;
    while (1 << params.levels < GUESS_BLUR_MOST * longer && longer >> (params.levels + 1) > 0)
        params.levels++;
    return orl_tex_create(gpu, &params, &soften->guesses);
}

void orl_soften_prepare(struct orl_gpu *gpu, const struct soften *soften,
                        const struct orl_tex *accumulated, const struct orl_tex *trusted)
{
    int width = soften->guesses->params.width, height = soften->guesses->params.height;
    struct image_block block = {.area = {width, height}};
    struct orl_dispatch d = {.prog = soften->seed, .params = &block,
                             .images = {{accumulated, 0, GL_READ_ONLY},
                                        {soften->guesses, 0, GL_WRITE_ONLY},
                                        {trusted, 0, GL_READ_ONLY}}};
    orl_pixel_groups(width, height, d.groups);
    if (soften->seed)
        orl_gpu_dispatch(gpu, &d);
    orl_tex_make_mipmaps(soften->guesses, 0);
}
