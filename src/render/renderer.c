// The frame: proxy, visibility, gather, fill, read back.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/internal.h"

// What stays after photographs: points, and targets of the usual sizes.
static size_t fixed_bytes(const struct orl_scene *scene, const struct proxy *proxy)
{
    int width = 1, height = 1;
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_camera *c = &scene->photos[i].view.camera;
        width = c->width > width ? c->width : width;
        height = c->height > height ? c->height : height;
    }
    return scene->points.count * 24 + 2 * orl_proxy_target_bytes(proxy, width, height) +
           (size_t)width * (size_t)height * (16 + 38 + 20);
}

enum orl_result orl_renderer_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                    const struct orl_renderer_params *params,
                                    struct orl_renderer **out)
{
    static const struct orl_renderer_params defaults = {0};
    const struct orl_log *log = orl_gpu_log(gpu);
    *out = NULL;
    params = params ? params : &defaults;
    struct orl_renderer *r = orl_array(log, 1, sizeof *r);
    if (!r)
        return ORL_ERR_MEMORY;
    r->gpu = gpu;
    r->scene = scene;
    size_t budget = 0;
    enum orl_result result = orl_proxy_init(gpu, &scene->points, &r->proxy);
    if (result == ORL_OK && params->max_vram_bytes) {
        size_t fixed = fixed_bytes(scene, &r->proxy);
        budget = params->max_vram_bytes > fixed ? params->max_vram_bytes - fixed : 1;
        orl_logf(log, ORL_LOG_INFO,
                 "device memory: %zu MiB allowed, %zu MiB for points and targets, %zu MiB for "
                 "photographs", params->max_vram_bytes >> 20, fixed >> 20, budget >> 20);
    }
    if (result == ORL_OK)
        result = orl_photos_init(gpu, scene, params, budget, &r->photos);
    if (result == ORL_OK)
        result = orl_fill_init(gpu, scene->photo_distance > 0 ? (float)scene->photo_distance : 1.0f,
                               params->radiance, &r->fill);
    if (result == ORL_OK)
        result = orl_soften_init(gpu, params->radiance, &r->soften);
    if (result == ORL_OK)
        result = params->radiance ? ORL_OK : orl_edges_init(gpu, &r->edges);
    if (result == ORL_OK)
        result = orl_gather_init(gpu, scene->photo_count, params->radiance, &r->gather);
    if (result == ORL_OK)
        result = orl_prog_create(gpu, "fill/compose.comp", params->radiance ? "RADIANCE" : NULL,
                                 sizeof(struct image_block), &r->compose);
    if (result == ORL_OK && !params->radiance)
        result = orl_prog_create(gpu, "fill/compose.comp", "REST", sizeof(struct image_block),
                                 &r->compose_rest);
    if (result != ORL_OK) {
        orl_renderer_destroy(&r);
        return result;
    }
    *out = r;
    return ORL_OK;
}

void orl_renderer_destroy(struct orl_renderer **renderer)
{
    struct orl_renderer *r = *renderer;
    if (!r)
        return;
    orl_proxy_finish(r->gpu, &r->proxy);
    orl_photos_finish(r->gpu, &r->photos);
    orl_fill_finish(r->gpu, &r->fill);
    orl_soften_finish(r->gpu, &r->soften);
    orl_edges_finish(r->gpu, &r->edges);
    orl_gather_finish(r->gpu, &r->gather);
    orl_prog_destroy(r->gpu, &r->compose);
    orl_prog_destroy(r->gpu, &r->compose_rest);
    orl_proxy_target_finish(r->gpu, &r->target);
    orl_image_finish(&r->staging);
    orl_tex_destroy(r->gpu, &r->accumulated);
    orl_tex_destroy(r->gpu, &r->trusted);
    free(r);
    *renderer = NULL;
}

static enum orl_result resize(struct orl_renderer *r, int width, int height, GLenum format)
{
    enum orl_result result = orl_proxy_target_resize(r->gpu, &r->proxy, &r->target, width,
                                                     height);
    if (result == ORL_OK)
        result = orl_fill_resize(r->gpu, &r->fill, width, height);
    if (result == ORL_OK)
        result = orl_soften_resize(r->gpu, &r->soften, width, height);
    if (result == ORL_OK && !r->photos.radiance)
        result = orl_edges_resize(r->gpu, &r->edges, width, height);
    const struct orl_tex *old = r->accumulated;
    if (result != ORL_OK || (old && old->params.width == width && old->params.height == height &&
                             old->params.format == format))
        return result;
    orl_tex_destroy(r->gpu, &r->accumulated);
    struct orl_tex_params params = {.width = width, .height = height, .format = format,
                                    .tag = "accumulated colour"};
    result = orl_tex_create(r->gpu, &params, &r->accumulated);
    if (result != ORL_OK || !r->photos.radiance)
        return result;
    orl_tex_destroy(r->gpu, &r->trusted);
    params.tag = "trust";
    return orl_tex_create(r->gpu, &params, &r->trusted);
}

struct proxy_options orl_proxy_options(const struct orl_render_params *params)
{
    return (struct proxy_options){.splat_scale = params->splat_scale,
                                  .front_layer = params->front_layer,
                                  .min_support = params->min_support,
                                  .points_per_pixel = params->points_per_pixel};
}

void orl_accumulated_clear(struct orl_renderer *r)
{
    orl_tex_clear(r->accumulated, 0);
    if (r->trusted)
        orl_tex_clear(r->trusted, 0);
}

static void compose(struct orl_renderer *r, const struct orl_render_params *params, bool finished)
{
    struct image_block block = {.area = {r->target.width, r->target.height,
                                         params->color == ORL_COLOR_POINTS,
                                         params->fill != ORL_FILL_NONE}};
    struct orl_dispatch d = {.prog = finished ? r->compose_rest : r->compose, .params = &block,
                             .bufs = {[2] = {.buf = finished ? r->gather.unfinished : NULL}},
                             .textures = {r->soften.guesses},
                             .indirect = finished ? r->gather.unfinished : NULL,
                             .images = {{r->accumulated, 0, GL_READ_WRITE},
                                        {r->fill.level[0], 0, GL_READ_ONLY},
                                        {r->target.depth, 0, GL_READ_ONLY},
                                        {r->trusted, 0, GL_READ_ONLY}},
                             .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                        GL_TEXTURE_UPDATE_BARRIER_BIT};
    orl_pixel_groups((r->target.width + 1) / 2, (r->target.height + 1) / 2, d.groups);
    if ((finished || r->trusted) && orl_fill_guesses(params) && params->guess_blur > 0)
        orl_soften_prepare(r->gpu, &r->soften, r->accumulated, r->trusted);
    orl_gpu_dispatch(r->gpu, &d);
}

static enum orl_result draw(struct orl_renderer *r, const struct orl_view *view,
                            const struct orl_render_params *params, const bool *skip,
                            bool normals)
{
    struct orl_gpu *gpu = r->gpu;
    enum orl_result result = ORL_OK;
    bool finished = orl_blends_at_once(r, params);
    struct proxy_options options = orl_proxy_options(params);
    // The splats' own colours show where they are in front, which the normal tells.
    normals = normals || params->color == ORL_COLOR_POINTS;
    orl_proxy_draw(gpu, &r->proxy, view, &options, normals, &r->target);
    if (params->color == ORL_COLOR_PHOTOS) {
        if (orl_fill_guesses(params)) {
            orl_pass_begin(gpu, "fill");
            orl_fill_depth(gpu, &r->fill, view,
                           params->fill == ORL_FILL_GROUND ? &r->scene->ground : NULL,
                           r->target.depth);
            orl_pass_end(gpu);
        }
        result = orl_gather(r, view, params, skip);
    } else {
        orl_pass_begin(gpu, "gather");
        orl_accumulated_clear(r);
        orl_proxy_color(gpu, &r->proxy, view, &r->target, r->accumulated);
        orl_pass_end(gpu);
    }
    if (result != ORL_OK)
        return result;
    orl_pass_begin(gpu, "fill");
    if (params->fill != ORL_FILL_NONE)
        orl_fill_color(gpu, &r->fill, finished ? NULL : r->accumulated);
    compose(r, params, finished);
    orl_pass_end(gpu);
    if (params->antialias == ORL_ANTIALIAS_ON && !r->photos.radiance)
        orl_edges_antialias(gpu, &r->edges, r->target.depth, r->accumulated);
    return ORL_OK;
}

void orl_frame_finish(struct orl_frame *frame)
{
    orl_image_finish(&frame->color);
    orl_image_finish(&frame->depth);
    orl_image_finish(&frame->normal);
    orl_image_finish(&frame->coverage);
    orl_image_finish(&frame->confidence);
}

enum orl_result orl_renderer_draw(struct orl_renderer *r, const struct orl_view *view,
                                  const struct orl_render_params *params, const bool *skip,
                                  struct orl_frame *frame)
{
    const struct orl_log *log = orl_gpu_log(r->gpu);
    if (frame)
        memset(frame, 0, sizeof *frame);
    if (!orl_camera_valid(&view->camera))
        return orl_fail(log, ORL_ERR_ARGUMENT, "this camera cannot be rendered: %dx%d, focal %g %g",
                        view->camera.width, view->camera.height, view->camera.fx, view->camera.fy);
    enum orl_result result = resize(r, view->camera.width, view->camera.height,
                                    orl_blends_at_once(r, params) ? GL_RGBA16F : GL_RGBA32F);
    if (result == ORL_OK)
        result = draw(r, view, params, skip, frame && !(params->leave_out & ORL_LAYER_NORMAL));
    if (result == ORL_OK)
        result = frame ? orl_read_back(r, params->leave_out, frame) : ORL_OK;
    if (result == ORL_OK)
        result = orl_gpu_finish(r->gpu);
    if (result != ORL_OK && frame)
        orl_frame_finish(frame);
    return result;
}
