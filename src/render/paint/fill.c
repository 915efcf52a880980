// Hole filling in image space by the pull-push of Gortler 1996: background depth and colour for
// pixels that nothing covers.
#include "core/memory.h"
#include "render/frame/method.h"
#include "render/paint/paint.h"
#include "shared/constants.h"

void orl_fill_finish(struct orl_gpu *gpu, struct fill *fill)
{
    for (size_t i = 0; i < ORL_COUNT(fill->level); i++)
        orl_tex_destroy(gpu, &fill->level[i]);
    orl_tex_destroy(gpu, &fill->guesses);
}

enum orl_result orl_fill_resize(struct orl_gpu *gpu, struct fill *fill, int width, int height)
{
    struct orl_tex_params params = {.width = width, .height = height, .format = GL_RGBA32F, .tag = "fill pyramid"};
    fill->levels = 0;
    // Sizes from half the picture's down to one pixel, rounded up. Loads outside a level give 0.
    do {
        params.width = (params.width + 1) / 2;
        params.height = (params.height + 1) / 2;
        ORL_TRY(orl_tex_fit(gpu, &params, &fill->level[fill->levels++]));
    } while (params.width > 1 || params.height > 1);
    params = (struct orl_tex_params){.width = (width + 1) / 2, .height = (height + 1) / 2, .levels = 1,
                                     .linear = true, .format = GL_RGBA32F, .tag = "guesses"};
    // A texel of the coarsest level is as large as the largest blur, or as the whole picture.
    int longer = width > height ? width : height;
    float most = (float)ORL_BLUR_MAX * (float)longer;
    while ((float)(1 << params.levels) < most && longer >> (params.levels + 1) > 0)
        params.levels++;
    return orl_tex_fit(gpu, &params, &fill->guesses);
}

void orl_fill_size(int width, int height, int size[2])
{
    size[0] = (width + 2 * ORL_FILL_RUN - 1) / (2 * ORL_FILL_RUN);
    size[1] = (height + 1) / 2;
}

// One program from texture to texture. applies: it is of shaders/fill/apply.glsl, else an invocation is for a pixel
// of `to`. beside: read besides, may be NULL.
static void run(const struct frame *frame, const char *file, const char *defines, bool applies, const struct orl_tex *from,
                const struct orl_tex *beside, const struct orl_tex *to)
{
    int width = to->params.width, height = to->params.height;
    struct image_block block = frame->paint->fill.block;
    block.image_size[0] = width;
    block.image_size[1] = height;
    struct orl_dispatch d = {.prog = orl_prog_get(frame->gpu, file, NULL, defines), ORL_PARAMS(block),
                             .images = {from, to, beside}, .size = {width, height}};
    if (applies)
        orl_fill_size(width, height, d.size);
    orl_gpu_dispatch(frame->gpu, &d);
}

static void seed(const struct frame *frame, const char *what, const struct orl_tex *from, const struct orl_tex *beside)
{
    run(frame, "fill/fill_seed.comp", what, false, from, beside, frame->paint->fill.level[0]);
}

// Spreads the known values of level 0 over all of it (pull-push, Gortler 1996). how: "FAR" (fill.glsl),
// or NULL.
static void spread(const struct frame *frame, const char *how)
{
    struct orl_tex *const *level = frame->paint->fill.level;
    for (int i = 1; i < frame->paint->fill.levels; i++)
        run(frame, "fill/fill_pull.comp", how, false, level[i - 1], NULL, level[i]);
    for (int i = frame->paint->fill.levels - 2; i >= 0; i--)
        run(frame, "fill/fill_push.comp", how, true, level[i + 1], NULL, level[i]);
}

// What level 0 says of the pixels of a picture, by a program of shaders/fill/apply.glsl.
static void apply(const struct frame *frame, const char *file, const struct orl_tex *picture)
{
    run(frame, file, NULL, true, frame->paint->fill.level[0], NULL, picture);
}

void orl_fill_depth(const struct frame *frame)
{
    struct image_block *block = &frame->paint->fill.block;
    struct orl_tex *depth = frame->surface.depth;
    double distance = frame->scene->photo_distance;
    block->depth_scale = distance > 0 ? (float)distance : 1.0f;
    orl_set_focal(&frame->view->camera, block->focal);
    orl_frame_ground(frame, block->ground);
    orl_pass_begin(frame->gpu, "fill");
    seed(frame, "SEED_DEPTH", depth, frame->surface.normal);
    spread(frame, "FAR");
    apply(frame, "fill/fill_depth.comp", depth);
    orl_pass_end(frame->gpu);
}

// Pixels that clip in every photograph take the brightness of the sufficiently bright light around.
static void restore_highlights(const struct frame *frame)
{
    seed(frame, "SEED_LEAST", frame->picture, NULL);
    spread(frame, NULL);
    seed(frame, "SEED_BRIGHTER", frame->picture, NULL);
    spread(frame, NULL);
    apply(frame, "fill/fill_highlights.comp", frame->picture);
}

void orl_fill_room(const struct frame *frame, struct orl_tex *room)
{
    seed(frame, NULL, room, NULL);
    spread(frame, NULL);
    apply(frame, "fill/fill_room.comp", room);
}

enum orl_result orl_fill_color(const struct frame *frame)
{
    // Before a complete room only surfaces are left to fill, and the walls' colours are not theirs.
    bool surfaces = frame->params->fill == ORL_FILL_ROOM && !frame->params->paint->layers;
    if (frame->radiance)
        restore_highlights(frame);
    if (!frame->finishes)
        seed(frame, surfaces ? "SEED_SURFACES" : NULL, frame->picture, frame->surface.depth);
    spread(frame, NULL);
    return ORL_OK;
}

enum orl_result orl_fill_guesses(const struct frame *frame)
{
    struct orl_tex *guesses = frame->paint->fill.guesses;
    if (frame->radiance)
        run(frame, "fill/fill_seed.comp", "SEED_GUESSES", false, frame->picture, frame->paint->trusted, guesses);
    orl_tex_make_mipmaps(guesses, 0);
    return ORL_OK;
}
