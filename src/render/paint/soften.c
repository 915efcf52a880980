#include "render/paint/soften.h"

#include "render/paint/paint.h"
#include "shared/constants.h"
#include "shared/render_blocks.h"

void orl_soften_finish(struct orl_gpu *gpu, struct soften *soften)
{
    orl_tex_destroy(gpu, &soften->guesses);
}

enum orl_result orl_soften_resize(struct orl_gpu *gpu, struct soften *soften, int width,
                                  int height)
{
    struct orl_tex_params params = {.width = (width + 1) / 2, .height = (height + 1) / 2,
                                    .levels = 1, .linear = true, .format = GL_RGBA32F,
                                    .tag = "guesses"};
    // A texel of the coarsest level is as large as the largest blur, or as the whole picture.
    int longer = width > height ? width : height;
    float most = (float)ORL_BLUR_MAX * (float)longer;
    while ((float)(1 << params.levels) < most && longer >> (params.levels + 1) > 0)
        params.levels++;
    return orl_tex_fit(gpu, &params, &soften->guesses);
}

void orl_soften_prepare(const struct frame *frame)
{
    struct orl_tex *guesses = frame->paint->soften.guesses;
    int width = guesses->params.width, height = guesses->params.height;
    if (frame->radiance) {
        struct image_block block = {.image_size = {width, height}};
        struct orl_dispatch d = {
            .prog = orl_prog_get(frame->gpu, "fill/fill_seed.comp", NULL, "SEED_GUESSES"),
            .params = &block, .params_size = sizeof block,
            .images = {{frame->picture, 0, GL_READ_ONLY}, {guesses, 0, GL_WRITE_ONLY},
                       {frame->paint->trusted, 0, GL_READ_ONLY}}};
        orl_pixel_groups(width, height, d.groups);
        orl_gpu_dispatch(frame->gpu, &d);
    }
    orl_tex_make_mipmaps(guesses, 0);
}
