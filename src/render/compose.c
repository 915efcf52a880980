#include "render/internal.h"

#include "render/frame/method.h"
#include "render/paint/paint.h"

static bool fills(const struct frame *frame)
{
    return frame->params->fill != ORL_FILL_NONE;
}

static bool softens(const struct frame *frame)
{
    return (frame->finishes || frame->radiance) && orl_params_guess(frame->params) &&
           frame->params->guess_blur > 0;
}

static bool antialiases(const struct frame *frame)
{
    return frame->params->antialias == ORL_ANTIALIAS_ON && !frame->radiance;
}

static enum orl_result compose(const struct frame *frame)
{
    const char *defines = frame->finishes ? "FINISHED" : frame->radiance ? "RADIANCE" : NULL;
    struct image_block block = {
        .image_size = {frame->surface.width, frame->surface.height},
        .points_show = frame->params->paint == &orl_paint_points,
        .fills = fills(frame),
        .layers = frame->params->paint->layers,
    };
    struct orl_dispatch d = {.prog = orl_prog_get(frame->gpu, "fill/compose.comp", NULL, defines), ORL_PARAMS(block),
                             .textures = {frame->paint->fill.guesses},
                             .images = {frame->paint->fill.level[0], frame->picture, frame->surface.depth,
                                        frame->paint->trusted}};
    orl_fill_size(frame->surface.width, frame->surface.height, d.size);
    orl_gpu_dispatch(frame->gpu, &d);
    return ORL_OK;
}

static bool takes_median(const struct frame *frame)
{
    return frame->params->median != ORL_MEDIAN_OFF && !frame->finishes;
}

// Filters the picture into states[0] and copies it back.
static enum orl_result median(const struct frame *frame)
{
    bool holes = frame->params->median == ORL_MEDIAN_HOLES;
    struct image_block block = {.image_size = {frame->surface.width, frame->surface.height}};
    orl_gpu_dispatch(frame->gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, "fill/median.comp", NULL, holes ? "HOLES" : NULL), ORL_PARAMS(block),
        .images = {frame->picture, frame->paint->states[0], frame->surface.depth},
        .size = {frame->surface.width, frame->surface.height}});
    orl_tex_copy_layer(frame->paint->states[0], 0, frame->surface.width, frame->surface.height,
                       frame->picture, 0);
    return ORL_OK;
}

static bool shows_soft_splats(const struct frame *frame)
{
    return frame->paint->soft.shows;
}

enum orl_result orl_compose(const struct frame *frame)
{
    static const struct {
        const char *name;
        bool (*applies)(const struct frame *frame); // NULL: always
        enum orl_result (*run)(const struct frame *frame);
    } passes[] = {
        {"fill", fills, orl_fill_color},
        {"soften", softens, orl_fill_guesses},
        {"compose", NULL, compose},
        {"median", takes_median, median},
        {"soft splats", shows_soft_splats, orl_soft_layer_mix},
        {"specks", orl_edges_find_specks, orl_edges_remove_specks},
        {"antialias", antialiases, orl_edges_antialias},
    };
    for (size_t i = 0; i < ORL_COUNT(passes); i++) {
        if (passes[i].applies && !passes[i].applies(frame))
            continue;
        orl_pass_begin(frame->gpu, passes[i].name);
        enum orl_result result = passes[i].run(frame);
        orl_pass_end(frame->gpu);
        ORL_TRY(result);
    }
    return ORL_OK;
}
