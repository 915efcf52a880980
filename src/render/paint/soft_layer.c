#include "render/paint/paint.h"

#include <math.h>

#include "render/photos/photos.h"
#include "shared/constants.h"
#include "soft/soft_ply.h"

static enum orl_result load(const struct frame *frame)
{
    struct orl_soft_model model = {0};
    enum orl_result result = orl_soft_read_scene(orl_gpu_log(frame->gpu), frame->scene->dir, &model);
    ORL_THEN(result, orl_soft_raster_init(frame->gpu, &model, &frame->paint->soft.raster));
    orl_soft_finish(&model);
    return result;
}

// Draws the splats into a view, in which what is coarse in photographs is `pixels` wide.
static enum orl_result draw(struct orl_gpu *gpu, struct orl_soft_raster *raster, const struct orl_view *view,
                            double pixels, struct soft_block *block)
{
    ORL_TRY(orl_soft_raster_draw(gpu, raster, view, true, block));
    orl_tex_make_mipmaps(raster->blended, 0);
    block->mean_level = (float)fmax(log2(pixels), 0);
    return ORL_OK;
}

static double coarse_pixels(const struct orl_camera *camera)
{
    return fmax(camera->width, camera->height) / ORL_SOFT_COARSE;
}

// --- in photographs ---

enum orl_result orl_soft_layer_keep(struct orl_gpu *gpu, struct orl_soft_raster *raster, const struct orl_view *view,
                                    struct orl_tex *slots, int slot)
{
    struct soft_block block;
    ORL_TRY(draw(gpu, raster, view, coarse_pixels(&view->camera), &block));
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "soft/keep.comp", NULL, NULL), ORL_PARAMS(block),
        .textures = {raster->blended}, .images = {slots}, .layer = slot,
        .size = {slots->params.width, slots->params.height}});
    return ORL_OK;
}

static enum orl_result keep(const struct frame *frame, size_t photo)
{
    struct photos *photos = frame->photos;
    struct photo_state *state = &photos->states[photo];
    const struct orl_view view = {state->color_camera, photos->scene->photos[photo].view.cam_from_world};
    ORL_TRY(orl_photos_array(frame->gpu, photos, GL_R8, "soft splats in photographs", &photos->soft));
    ORL_TRY(orl_soft_layer_keep(frame->gpu, &frame->paint->soft.raster, &view, photos->soft, state->slot));
    orl_tex_make_mipmaps(photos->soft, state->slot);
    state->has_soft = true;
    return ORL_OK;
}

// Makes the textures of the view's size.
static enum orl_result resize(const struct frame *frame)
{
    struct soft_layer *layer = &frame->paint->soft;
    const struct orl_camera *c = &frame->view->camera;
    const struct orl_tex_params params = {.width = c->width, .height = c->height,
                                          .levels = orl_mip_levels(c->width, c->height), .format = GL_R16F,
                                          .linear = true, .tag = "difference of soft splats"};
    ORL_TRY(orl_frame_target(frame, "soft splats of photographs", true, GL_R16F, &layer->gathered));
    return orl_tex_fit(frame->gpu, &params, &layer->differs);
}

enum orl_result orl_soft_layer_ready(struct frame *frame)
{
    size_t made = 0, left = 0;
    if (!frame->paint->soft.raster.splats)
        ORL_TRY(load(frame));
    ORL_TRY(resize(frame));
    for (size_t i = 0; i < frame->chosen_count; i++) {
        if (frame->photos->states[frame->chosen[i]].has_soft)
            continue;
        if (frame->progressive && made > 0) {
            left++;
            continue;
        }
        ORL_TRY(keep(frame, frame->chosen[i]));
        made++;
    }
    if (left > 0 || frame->chosen_count == 0) {
        if (frame->progressive)
            frame->progressive->missing += left;
        frame->paint->soft.shows = false;
    }
    return ORL_OK;
}

// --- in the view ---

static double coarse_pixels_of_view(const struct frame *frame)
{
    double sum = 0;
    for (size_t i = 0; i < frame->chosen_count; i++) {
        const struct orl_camera *c = &frame->photos->states[frame->chosen[i]].color_camera;
        sum += coarse_pixels(c) / c->fx;
    }
    return sum / (double)frame->chosen_count * frame->view->camera.fx;
}

enum orl_result orl_soft_layer_mix(const struct frame *frame)
{
    struct soft_layer *layer = &frame->paint->soft;
    struct soft_block block;
    ORL_TRY(draw(frame->gpu, &layer->raster, frame->view, coarse_pixels_of_view(frame), &block));
    block.correct_share = frame->params->soft;
    block.mix_share = frame->params->soft_mix;
    orl_gpu_dispatch(frame->gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, "soft/compare.comp", NULL, NULL), ORL_PARAMS(block),
        .textures = {layer->raster.blended}, .images = {layer->gathered, layer->differs},
        .size = {frame->surface.width, frame->surface.height}});
    orl_tex_make_mipmaps(layer->differs, 0);
    const char *specks = orl_edges_find_specks(frame) ? "SPECKS" : NULL;
    orl_gpu_dispatch(frame->gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, "soft/mix.comp", NULL, specks), ORL_PARAMS(block),
        .textures = {layer->differs},
        .images = {[1] = frame->picture, layer->raster.blended, frame->paint->edges.painted},
        .size = {frame->surface.width, frame->surface.height}});
    return ORL_OK;
}

void orl_soft_layer_finish(struct orl_gpu *gpu, struct soft_layer *layer)
{
    orl_soft_raster_finish(gpu, &layer->raster);
    orl_tex_destroy(gpu, &layer->gathered);
    orl_tex_destroy(gpu, &layer->differs);
}
