#include "soft/descent.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/process.h"

static const double LAST_SIZE = 0.1; // factor on the step sizes of the last step
static const double LOSS_SMOOTHED = 0.98; // of the running mean

enum orl_result orl_soft_descent_init(struct orl_gpu *gpu, const struct orl_soft_model *model,
                                      struct orl_soft_descent *descent)
{
    const size_t bytes = model->count * sizeof *model->splats;
    *descent = (struct orl_soft_descent){0};
    enum orl_result result = orl_soft_raster_init(gpu, model, &descent->raster);
    ORL_THEN(result, orl_buf_create(gpu, ORL_OWNER_POINTS, "mean gradients", bytes, model->moments, GL_RGBA32F,
                                    &descent->mean));
    ORL_THEN(result, orl_buf_create(gpu, ORL_OWNER_POINTS, "squared gradients", bytes,
                                    model->moments ? model->moments + model->count : NULL, GL_RGBA32F, &descent->square));
    if (result != ORL_OK)
        orl_soft_descent_finish(gpu, descent);
    return result;
}

void orl_soft_descent_finish(struct orl_gpu *gpu, struct orl_soft_descent *descent)
{
    orl_soft_raster_finish(gpu, &descent->raster);
    orl_buf_destroy(gpu, &descent->places);
    orl_buf_destroy(gpu, &descent->shares);
    orl_buf_destroy(gpu, &descent->mean);
    orl_buf_destroy(gpu, &descent->square);
    orl_tex_destroy(gpu, &descent->gradient_target);
    orl_image_finish(&descent->picture);
    orl_image_finish(&descent->gradient);
}

size_t orl_soft_descent_bytes(size_t splats, size_t entries, int width, int height)
{
    const size_t vec4 = 4 * sizeof(float), pixels = (size_t)width * (size_t)height;
    size_t own = splats * ((3 * ORL_SOFT_VEC4S + ORL_SOFT_SEEN_VEC4S) * vec4 + ORL_SOFT_BOUND_WORDS * sizeof(uint32_t));
    size_t lists = (splats + orl_soft_tiles(width, height) + 2 * entries + 2) * sizeof(int) + (entries + 1) * ORL_SOFT_SHARE_VEC4S * vec4;
    // orl_buf_fit makes lists larger by a half; the picture, its mip levels and its gradient are less than three.
    return own + lists + lists / 2 + 3 * pixels * vec4;
}

static enum orl_result check_memory(struct orl_gpu *gpu, const struct orl_soft_descent *d, const struct orl_camera *c)
{
    const struct orl_soft_raster *r = &d->raster;
    // Gradients of all entries are one buffer, whatever the limit of memory.
    if (r->lists.entries > (size_t)orl_gpu_caps(gpu)->max_buffer_texels / ORL_SOFT_SHARE_VEC4S)
        return orl_fail(orl_gpu_log(gpu), ORL_ERR_GPU,
                        "refine: %zu splats at %dx%d are in %zu places of the lists of this view, more than a buffer of "
                        "this device holds: give fewer --splats, or a larger --size-divide", r->count, c->width,
                        c->height, r->lists.entries);
    size_t bytes = orl_soft_descent_bytes(r->count, r->lists.entries, c->width, c->height);
    if (!d->max_bytes || bytes <= d->max_bytes)
        return ORL_OK;
    return orl_fail(orl_gpu_log(gpu), ORL_ERR_GPU,
                    "refine: %zu MiB of device memory are not enough for %zu splats at %dx%d, which need %.1f MiB "
                    "with the lists of this view: give fewer --splats, or a larger --size-divide", d->max_bytes >> 20, r->count, c->width,
                    c->height, (double)bytes / (1 << 20));
}

// Makes what depends on the view's size fit.
static enum orl_result resize(struct orl_gpu *gpu, struct orl_soft_descent *d, int width, int height)
{
    if (d->picture.data && d->picture.width == width && d->picture.height == height)
        return ORL_OK;
    const struct orl_log *log = orl_gpu_log(gpu);
    orl_image_finish(&d->picture);
    orl_image_finish(&d->gradient);
    ORL_TRY(orl_image_init(log, &d->picture, width, height, 4, ORL_PIXEL_F32));
    ORL_TRY(orl_image_init(log, &d->gradient, width, height, 4, ORL_PIXEL_F32));
    return orl_tex_fit(gpu, &(struct orl_tex_params){.width = width, .height = height, .format = GL_RGBA32F,
                                                     .owner = ORL_OWNER_FRAME, .tag = "gradient of the picture"},
                       &d->gradient_target);
}

// Sums the gradients of each splat and steps against them.
static enum orl_result update(struct orl_gpu *gpu, struct orl_soft_descent *d, const struct soft_block *block)
{
    const struct orl_soft_raster *r = &d->raster;
    const size_t places = (r->count + 1 + r->lists.entries) * sizeof(int);
    const size_t shares = (r->lists.entries ? r->lists.entries : 1) * ORL_SOFT_SHARE_VEC4S * 4 * sizeof(float);
    ORL_TRY(orl_buf_fit(gpu, ORL_OWNER_POINTS, "places of soft splats", places, 0, &d->places));
    ORL_TRY(orl_buf_fit(gpu, ORL_OWNER_POINTS, "gradients of tiles", shares, GL_RGBA32F, &d->shares));
    orl_buf_write(d->places, 0, places, r->lists.places);
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "soft/backward.comp", NULL, NULL), ORL_PARAMS(*block),
        .images = {r->blended, d->gradient_target, [5] = &d->shares->texels, &r->projected->texels,
                   &r->listed->texels},
        .size = ORL_SOFT_SIZE(r->lists.tiles)});
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "soft/update.comp", NULL, NULL), ORL_PARAMS(*block),
        .bufs = {[2] = r->bounds, [3] = d->places},
        .images = {[2] = &r->splats->texels, &d->mean->texels, &d->square->texels, &d->shares->texels,
                   &r->projected->texels},
        .size = ORL_SOFT_SIZE(r->count)});
    return ORL_OK;
}

enum orl_result orl_soft_descent_step(struct orl_gpu *gpu, struct orl_soft_descent *d,
                                      const struct orl_soft_photo *photo, float decay, double *loss)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct soft_block block;
    ORL_TRY(orl_soft_raster_draw(gpu, &d->raster, &photo->view, false, &block));
    ORL_TRY(check_memory(gpu, d, &photo->view.camera));
    ORL_TRY(resize(gpu, d, photo->view.camera.width, photo->view.camera.height));
    orl_tex_read(d->raster.blended, 0, GL_RGBA, GL_FLOAT, orl_image_bytes(&d->picture), d->picture.f32);
    ORL_TRY(orl_gpu_finish(gpu));
    ORL_TRY(orl_soft_loss(log, &d->picture, &photo->color, photo->use.data ? &photo->use : NULL, &d->gradient, loss));
    orl_tex_write(d->gradient_target, GL_RGBA, GL_FLOAT, d->gradient.f32);
    block.eye[3] = decay;
    return update(gpu, d, &block);
}

// Puts the numbers from 0 on into a random order (Fisher and Yates).
static void shuffle(size_t *order, size_t count, uint64_t *state)
{
    for (size_t i = count - 1; i > 0; i--) {
        size_t k = (size_t)(orl_soft_random(state) * (double)(i + 1)), other = order[i];
        order[i] = order[k];
        order[k] = other;
    }
}

static enum orl_result run(struct orl_gpu *gpu, struct orl_soft_descent *d, const struct orl_soft_photo *photos,
                           size_t *order, size_t count, const struct orl_soft_descent_params *params,
                           struct orl_soft_descent_report *report)
{
    uint64_t state = 0x2545f4914f6cdd1du ^ (params->seed + 1) * 0x9e3779b97f4a7c15u;
    const double started = orl_time_s() - report->spent_s, part_end_s = report->spent_s + params->part_s;
    const int from = report->steps;
    for (int s = 0; s < params->steps; s++) {
        report->spent_s = orl_time_s() - started;
        if ((size_t)s % count == 0) {
            if (s > from && report->spent_s > part_end_s)
                return orl_gpu_finish(gpu);
            shuffle(order, count, &state);
        }
        if (s < from)
            continue; // an earlier call made this step; only the order of the photographs is needed
        if (params->budget_s > 0 && report->spent_s > params->budget_s)
            break;
        if (orl_progress_cancelled(params->progress))
            return ORL_ERR_CANCELLED;
        double loss, share = (double)(s + 1) / params->steps;
        double decay = pow(params->first_size, 1 - share) * pow(LAST_SIZE, share);
        ORL_TRY(orl_soft_descent_step(gpu, d, &photos[order[(size_t)s % count]], (float)decay, &loss));
        report->loss = s ? LOSS_SMOOTHED * report->loss + (1 - LOSS_SMOOTHED) * loss : loss;
        report->steps = s + 1;
        orl_progress_report(params->progress, "descent", s + 1, params->steps, NULL);
    }
    report->done = true;
    return orl_gpu_finish(gpu);
}

enum orl_result orl_soft_descend(struct orl_gpu *gpu, const struct orl_soft_photo *photos, size_t count,
                                 const struct orl_soft_descent_params *params, struct orl_soft_model *model,
                                 struct orl_soft_descent_report *report)
{
    ORL_REQUIRE(orl_gpu_log(gpu), count > 0 && model->count > 0);
    const size_t bytes = model->count * sizeof *model->splats;
    struct orl_soft_descent descent = {0};
    size_t *order = orl_array(orl_gpu_log(gpu), count, sizeof *order);
    if (!model->moments)
        model->moments = orl_array(orl_gpu_log(gpu), 2 * model->count, sizeof *model->moments);
    enum orl_result result = order && model->moments ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; order && i < count; i++)
        order[i] = i;
    ORL_THEN(result, orl_soft_descent_init(gpu, model, &descent));
    descent.max_bytes = params->max_bytes;
    ORL_THEN(result, run(gpu, &descent, photos, order, count, params, report));
    if (result == ORL_OK) {
        orl_buf_read(descent.raster.splats, bytes, model->splats);
        orl_buf_read(descent.mean, bytes, model->moments);
        orl_buf_read(descent.square, bytes, model->moments + model->count);
        result = orl_gpu_finish(gpu);
    }
    orl_soft_descent_finish(gpu, &descent);
    free(order);
    return result;
}
