// Image-space pull-push of Gortler 1996: background depth and colour for pixels that
// nothing covers.
#include <string.h>

#include "render/internal.h"
#include "scene/ground.h"

enum orl_result orl_fill_init(struct orl_gpu *gpu, float depth_scale, bool radiance,
                              struct fill *fill)
{
    memset(fill, 0, sizeof *fill);
    fill->block.scale[0] = depth_scale;
    const struct {
        const char *file, *defines;
        struct orl_prog **prog;
    } programs[] = {
        {"fill/fill_seed.comp", "SEED_DEPTH", &fill->seed_depth},
        {"fill/fill_seed.comp", NULL, &fill->seed_color},
        {"fill/fill_pull.comp", NULL, &fill->pull},
        {"fill/fill_push.comp", NULL, &fill->push},
        {"fill/fill_depth.comp", NULL, &fill->apply_depth},
        {"fill/fill_seed.comp", "SEED_LEAST", &fill->seed_least}, // from here on of radiance
        {"fill/fill_seed.comp", "SEED_BRIGHTER", &fill->seed_brighter},
        {"fill/fill_lift.comp", NULL, &fill->lift},
    };
    enum orl_result result = ORL_OK;
    size_t count = ORL_COUNT(programs) - (radiance ? 0 : 3);
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        result = orl_prog_create(gpu, programs[i].file, programs[i].defines,
                                 sizeof(struct image_block), programs[i].prog);
    if (result != ORL_OK)
        orl_fill_finish(gpu, fill);
    return result;
}

static void free_levels(struct orl_gpu *gpu, struct fill *fill)
{
    for (size_t i = 0; i < ORL_COUNT(fill->level); i++)
        orl_tex_destroy(gpu, &fill->level[i]);
    fill->width = fill->height = fill->levels = 0;
}

void orl_fill_finish(struct orl_gpu *gpu, struct fill *fill)
{
    free_levels(gpu, fill);
    orl_prog_destroy(gpu, &fill->seed_depth);
    orl_prog_destroy(gpu, &fill->seed_color);
    orl_prog_destroy(gpu, &fill->pull);
    orl_prog_destroy(gpu, &fill->push);
    orl_prog_destroy(gpu, &fill->apply_depth);
    orl_prog_destroy(gpu, &fill->seed_least);
    orl_prog_destroy(gpu, &fill->seed_brighter);
    orl_prog_destroy(gpu, &fill->lift);
}

enum orl_result orl_fill_resize(struct orl_gpu *gpu, struct fill *fill, int width, int height)
{
    if (fill->width == width && fill->height == height)
        return ORL_OK;
    free_levels(gpu, fill);
    enum orl_result result = ORL_OK;
    // From half the size down to one pixel, rounded up: image loads outside a level read 0.
    for (int w = (width + 1) / 2, h = (height + 1) / 2; result == ORL_OK;
         w = (w + 1) / 2, h = (h + 1) / 2) {
        struct orl_tex_params params = {.width = w, .height = h, .format = GL_RGBA32F,
                                        .tag = "fill pyramid"};
        result = orl_tex_create(gpu, &params, &fill->level[fill->levels]);
        if (result == ORL_OK)
            fill->levels++;
        if (w == 1 && h == 1)
            break;
    }
    if (result != ORL_OK) {
        free_levels(gpu, fill);
        return result;
    }
    fill->width = width;
    fill->height = height;
    return ORL_OK;
}

bool orl_fill_guesses(const struct orl_render_params *params)
{
    return params->fill == ORL_FILL_DEPTH || params->fill == ORL_FILL_GROUND;
}

static void run(struct orl_gpu *gpu, const struct fill *fill, struct orl_prog *prog,
                const struct orl_tex *first, GLenum first_access, const struct orl_tex *second,
                GLenum second_access, const struct orl_tex *covered)
{
    // These take 2x2 pixels an invocation.
    bool four = prog == fill->push || prog == fill->apply_depth || prog == fill->lift;
    int width = covered->params.width, height = covered->params.height;
    struct image_block block = fill->block;
    block.area[0] = width;
    block.area[1] = height;
    struct orl_dispatch d = {.prog = prog, .params = &block,
                             .images = {{first, 0, first_access}, {second, 0, second_access}},
                             .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                        GL_TEXTURE_FETCH_BARRIER_BIT};
    orl_pixel_groups(four ? (width + 1) / 2 : width, four ? (height + 1) / 2 : height, d.groups);
    orl_gpu_dispatch(gpu, &d);
}

static void spread(struct orl_gpu *gpu, struct fill *fill)
{
    for (int i = 1; i < fill->levels; i++)
        run(gpu, fill, fill->pull, fill->level[i - 1], GL_READ_ONLY, fill->level[i], GL_WRITE_ONLY,
            fill->level[i]);
    for (int i = fill->levels - 2; i >= 0; i--)
        run(gpu, fill, fill->push, fill->level[i], GL_READ_WRITE, fill->level[i + 1], GL_READ_ONLY,
            fill->level[i]);
}

// Farther than so many times the photographs' height, what stands on the ground hides it.
static const double GROUND_REACH = 20;

static void set_ground(struct image_block *block, const struct orl_view *view,
                       const struct orl_ground *ground)
{
    const struct orl_camera *c = &view->camera;
    const float focal[4] = {(float)c->fx, (float)c->fy, (float)c->cx, (float)c->cy};
    double inverse[3];
    memcpy(block->focal, focal, sizeof focal);
    memset(block->ground, 0, sizeof block->ground);
    if (!ground || !orl_ground_along_rays(ground, view, inverse))
        return;
    for (int k = 0; k < 3; k++)
        block->ground[k] = (float)inverse[k];
    block->ground[3] = (float)(1 / (GROUND_REACH * ground->height));
}

void orl_fill_depth(struct orl_gpu *gpu, struct fill *fill, const struct orl_view *view,
                    const struct orl_ground *ground, struct orl_tex *depth)
{
    set_ground(&fill->block, view, ground);
    run(gpu, fill, fill->seed_depth, depth, GL_READ_ONLY, fill->level[0], GL_WRITE_ONLY,
        fill->level[0]);
    spread(gpu, fill);
    run(gpu, fill, fill->apply_depth, fill->level[0], GL_READ_ONLY, depth, GL_READ_WRITE, depth);
}

// What clips in every photograph is as bright as what around it is bright enough.
static void lift(struct orl_gpu *gpu, struct fill *fill, struct orl_tex *accumulated)
{
    run(gpu, fill, fill->seed_least, accumulated, GL_READ_ONLY, fill->level[0], GL_WRITE_ONLY,
        fill->level[0]);
    spread(gpu, fill);
    run(gpu, fill, fill->seed_brighter, accumulated, GL_READ_ONLY, fill->level[0], GL_READ_WRITE,
        fill->level[0]);
    spread(gpu, fill);
    run(gpu, fill, fill->lift, fill->level[0], GL_READ_ONLY, accumulated, GL_READ_WRITE,
        accumulated);
}

void orl_fill_color(struct orl_gpu *gpu, struct fill *fill, struct orl_tex *accumulated)
{
    if (accumulated && fill->lift)
        lift(gpu, fill, accumulated);
    if (accumulated)
        run(gpu, fill, fill->seed_color, accumulated, GL_READ_ONLY, fill->level[0], GL_WRITE_ONLY,
            fill->level[0]);
    spread(gpu, fill);
}
