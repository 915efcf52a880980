// Hole filling in image space by the pull-push of Gortler 1996: background depth and colour for
// pixels that nothing covers.
#include "render/paint/fill.h"

#include "core/memory.h"
#include "render/frame/method.h"
#include "render/paint/paint.h"

void orl_fill_finish(struct orl_gpu *gpu, struct fill *fill)
{
    for (size_t i = 0; i < ORL_COUNT(fill->level); i++)
        orl_tex_destroy(gpu, &fill->level[i]);
    fill->width = fill->height = fill->levels = 0;
}

enum orl_result orl_fill_resize(struct orl_gpu *gpu, struct fill *fill, int width, int height)
{
    if (fill->width == width && fill->height == height)
        return ORL_OK;
    orl_fill_finish(gpu, fill);
    enum orl_result result = ORL_OK;
    // Sizes from half the picture's down to one pixel, rounded up. Loads outside a level give 0.
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
        orl_fill_finish(gpu, fill);
        return result;
    }
    fill->width = width;
    fill->height = height;
    return ORL_OK;
}

// One program from texture to texture, over the texture `covered`. per_invocation: pixels that one
// invocation handles in each direction. beside: read besides; NULL: nothing is.
struct step {
    const char *file, *defines;
    int per_invocation;
    const struct orl_tex *beside;
};

static void run(const struct frame *frame, struct step step, const struct orl_tex *first,
                GLenum first_access, const struct orl_tex *second, GLenum second_access,
                const struct orl_tex *covered)
{
    int width = covered->params.width, height = covered->params.height, n = step.per_invocation;
    struct image_block block = frame->paint->fill.block;
    block.image_size[0] = width;
    block.image_size[1] = height;
    struct orl_dispatch d = {.prog = orl_prog_get(frame->gpu, step.file, NULL, step.defines),
                             .params = &block, .params_size = sizeof block,
                             .images = {{first, 0, first_access}, {second, 0, second_access},
                                        {step.beside, 0, GL_READ_ONLY}},
                             .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                        GL_TEXTURE_FETCH_BARRIER_BIT};
    orl_pixel_groups((width + n - 1) / n, (height + n - 1) / n, d.groups);
    orl_gpu_dispatch(frame->gpu, &d);
}

// Spreads the known values of level 0 over all of it (pull-push, Gortler 1996). how: "FAR" (fill.glsl),
// or NULL.
static void spread(const struct frame *frame, const char *how)
{
    const struct step pull = {"fill/fill_pull.comp", how, 1, NULL};
    const struct step push = {"fill/fill_push.comp", how, 2, NULL};
    struct orl_tex *const *level = frame->paint->fill.level;
    for (int i = 1; i < frame->paint->fill.levels; i++)
        run(frame, pull, level[i - 1], GL_READ_ONLY, level[i], GL_WRITE_ONLY, level[i]);
    for (int i = frame->paint->fill.levels - 2; i >= 0; i--)
        run(frame, push, level[i], GL_READ_WRITE, level[i + 1], GL_READ_ONLY, level[i]);
}

static void seed(const struct frame *frame, const char *what, const struct orl_tex *from,
                 const struct orl_tex *beside, GLenum access)
{
    struct orl_tex *finest = frame->paint->fill.level[0];
    run(frame, (struct step){"fill/fill_seed.comp", what, 1, beside}, from, GL_READ_ONLY, finest,
        access, finest);
}

void orl_fill_depth(const struct frame *frame)
{
    static const struct step apply = {"fill/fill_depth.comp", NULL, 2, NULL};
    struct image_block *block = &frame->paint->fill.block;
    struct orl_tex *depth = frame->surface.depth;
    double distance = frame->scene->photo_distance;
    block->depth_scale = distance > 0 ? (float)distance : 1.0f;
    orl_set_focal(&frame->view->camera, block->focal);
    orl_frame_ground(frame, block->ground);
    orl_pass_begin(frame->gpu, "fill");
    seed(frame, "SEED_DEPTH", depth, frame->surface.normal, GL_WRITE_ONLY);
    spread(frame, "FAR");
    run(frame, apply, frame->paint->fill.level[0], GL_READ_ONLY, depth, GL_READ_WRITE, depth);
    orl_pass_end(frame->gpu);
}

// Pixels that clip in every photograph take the brightness of the sufficiently bright light around.
static void restore_highlights(const struct frame *frame)
{
    static const struct step apply = {"fill/fill_highlights.comp", NULL, 2, NULL};
    seed(frame, "SEED_LEAST", frame->picture, NULL, GL_WRITE_ONLY);
    spread(frame, NULL);
    seed(frame, "SEED_BRIGHTER", frame->picture, NULL, GL_READ_WRITE);
    spread(frame, NULL);
    run(frame, apply, frame->paint->fill.level[0], GL_READ_ONLY, frame->picture, GL_READ_WRITE,
        frame->picture);
}

void orl_fill_room(const struct frame *frame, struct orl_tex *room)
{
    static const struct step apply = {"fill/fill_room.comp", NULL, 2, NULL};
    seed(frame, NULL, room, NULL, GL_WRITE_ONLY);
    spread(frame, NULL);
    run(frame, apply, frame->paint->fill.level[0], GL_READ_ONLY, room, GL_READ_WRITE, room);
}

void orl_fill_color(const struct frame *frame)
{
    // Before a complete room only surfaces are left to fill, and the walls' colours are not theirs.
    bool surfaces = orl_frame_shows_room(frame) && !frame->params->paint->layers;
    if (frame->radiance)
        restore_highlights(frame);
    if (!frame->finishes)
        seed(frame, surfaces ? "SEED_SURFACES" : NULL, frame->picture, frame->surface.depth,
             GL_WRITE_ONLY);
    spread(frame, NULL);
}
