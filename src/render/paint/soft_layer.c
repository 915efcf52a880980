#include "render/paint/soft_layer.h"

#include <math.h>

#include "render/paint/paint.h"
#include "render/photos/photos.h"
#include "shared/constants.h"
#include "soft/soft_ply.h"

bool orl_soft_layer_shows(const struct frame *frame)
{
    return frame->paint->soft.shows;
}

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
    struct orl_dispatch d = {
        .prog = orl_prog_get(gpu, "soft/keep.comp", NULL, NULL),
        .params = &block, .params_size = sizeof block,
        .textures = {raster->blended},
        .images = {{slots, 0, GL_WRITE_ONLY}},
        .image_layers = {slot + 1},
        .barrier = GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT};
    orl_pixel_groups(slots->params.width, slots->params.height, d.groups);
    orl_gpu_dispatch(gpu, &d);
    return ORL_OK;
}

static enum orl_result keep(const struct frame *frame, size_t photo)
{
    struct photos *photos = frame->photos;
    struct photo_state *state = &photos->states[photo];
    struct orl_tex_params params = photos->color_params;
    const struct orl_view view = {state->color_camera, photos->scene->photos[photo].view.cam_from_world};
    params.format = GL_R8;
    params.tag = "soft splats in photographs";
    if (!photos->soft)
        ORL_TRY(orl_tex_create(frame->gpu, &params, &photos->soft));
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

static void dispatch(const struct frame *frame, struct orl_dispatch d)
{
    orl_pixel_groups(frame->surface.width, frame->surface.height, d.groups);
    orl_gpu_dispatch(frame->gpu, &d);
}

enum orl_result orl_soft_layer_mix(const struct frame *frame)
{
    struct soft_layer *layer = &frame->paint->soft;
    struct soft_block block;
    ORL_TRY(draw(frame->gpu, &layer->raster, frame->view, coarse_pixels_of_view(frame), &block));
    block.correct_share = frame->params->soft;
    block.mix_share = frame->params->soft_mix;
    dispatch(frame, (struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, "soft/compare.comp", NULL, NULL),
        .params = &block, .params_size = sizeof block,
        .textures = {layer->raster.blended},
        .images = {{layer->gathered, 0, GL_READ_ONLY}, {layer->differs, 0, GL_WRITE_ONLY}},
        .barrier = GL_TEXTURE_FETCH_BARRIER_BIT});
    orl_tex_make_mipmaps(layer->differs, 0);
    const char *specks = orl_edges_find_specks(frame) ? "SPECKS" : NULL;
    dispatch(frame, (struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, "soft/mix.comp", NULL, specks),
        .params = &block, .params_size = sizeof block, .textures = {layer->differs},
        .images = {[1] = {frame->picture, 0, GL_READ_WRITE}, {layer->raster.blended, 0, GL_READ_ONLY},
                   {specks ? frame->paint->edges.painted : NULL, 0, GL_READ_WRITE}},
        .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT});
    return ORL_OK;
}

void orl_soft_layer_finish(struct orl_gpu *gpu, struct soft_layer *layer)
{
    orl_soft_raster_finish(gpu, &layer->raster);
    orl_tex_destroy(gpu, &layer->gathered);
    orl_tex_destroy(gpu, &layer->differs);
}
