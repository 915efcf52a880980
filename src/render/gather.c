// Colour from photographs.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/internal.h"

enum { PHOTO_ROWS = 7 }; // image binding of shaders/gather/photo.glsl

_Static_assert(sizeof(struct photo_data) == 16 * ORL_PHOTO_VEC4S, "photo_data is vec4s");

static enum orl_result create(struct orl_gpu *gpu, const char *file, const char *defines,
                              struct orl_prog **prog)
{
    return orl_prog_create(gpu, file, defines, sizeof(struct gather_block), prog);
}

static enum orl_result create_programs(struct orl_gpu *gpu, struct gather *gather)
{
    static const char *const defines[ORL_SAMPLING_COUNT] = {[ORL_SAMPLING_BICUBIC] = "BICUBIC 1\n"};
    static const char *const few[ORL_SAMPLING_COUNT][KEPT_PROGRAMS] = {
        [ORL_SAMPLING_BILINEAR] = {"KEPT 2\n", "KEPT 4\n"},
        [ORL_SAMPLING_BICUBIC] = {"BICUBIC 1\nKEPT 2\n", "BICUBIC 1\nKEPT 4\n"}};
    enum orl_result result = create(gpu, "gather/choose.comp", NULL, &gather->choose);
    for (int i = 0; result == ORL_OK && i < ORL_SAMPLING_COUNT; i++) {
        result = create(gpu, "gather/gather.comp", defines[i], &gather->all[i]);
        for (int k = 0; result == ORL_OK && k < KEPT_PROGRAMS; k++)
            result = create(gpu, "gather/gather_best.comp", few[i][k], &gather->best[i][k]);
    }
    return result;
}

static enum orl_result create_radiance_programs(struct orl_gpu *gpu, struct gather *gather)
{
    static const char *const defines[ORL_BLEND_COUNT] = {[ORL_BLEND_BEST] = "BEST 1\n"};
    enum orl_result result = ORL_OK;
    for (int i = 0; result == ORL_OK && i < ORL_BLEND_COUNT; i++) {
        result = create(gpu, "gather/choose_radiance.comp", defines[i], &gather->choose_radiance[i]);
        if (result == ORL_OK)
            result = create(gpu, "gather/gather_radiance.comp", defines[i], &gather->radiance[i]);
    }
    return result;
}

enum orl_result orl_gather_init(struct orl_gpu *gpu, size_t photo_count, bool radiance,
                                struct gather *gather)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    memset(gather, 0, sizeof *gather);
    gather->list = orl_array(log, photo_count, sizeof *gather->list);
    gather->chosen = orl_array(log, photo_count, sizeof *gather->chosen);
    enum orl_result result = gather->list && gather->chosen ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_buf_create(gpu, "photographs of a frame",
                                photo_count * sizeof *gather->list, NULL, &gather->photos);
    if (result == ORL_OK)
        result = orl_tex_view_buffer(gpu, gather->photos, GL_RGBA32F, &gather->photo_rows);
    if (result == ORL_OK)
        result = radiance ? create_radiance_programs(gpu, gather) : create_programs(gpu, gather);
    if (result != ORL_OK)
        orl_gather_finish(gpu, gather);
    return result;
}

void orl_gather_finish(struct orl_gpu *gpu, struct gather *gather)
{
    for (int i = 0; i < ORL_SAMPLING_COUNT; i++) {
        orl_prog_destroy(gpu, &gather->all[i]);
        for (int k = 0; k < KEPT_PROGRAMS; k++)
            orl_prog_destroy(gpu, &gather->best[i][k]);
    }
    for (int i = 0; i < ORL_BLEND_COUNT; i++) {
        orl_prog_destroy(gpu, &gather->choose_radiance[i]);
        orl_prog_destroy(gpu, &gather->radiance[i]);
    }
    orl_prog_destroy(gpu, &gather->choose);
    orl_tex_destroy(gpu, &gather->photo_rows);
    orl_buf_destroy(gpu, &gather->photos);
    orl_buf_destroy(gpu, &gather->tile_lists);
    orl_buf_destroy(gpu, &gather->unfinished);
    free(gather->list);
    free(gather->chosen);
    memset(gather, 0, sizeof *gather);
}

// photo_from_view = photo_from_world * world_from_view, in doubles: both translations
// may be large where their difference is small.
static void relative_pose(const struct orl_pose *photo, const struct orl_pose *view,
                          struct photo_data *data)
{
    double eye[3], offset[3], photo_eye[3], in_view[3];
    orl_pose_centre(view, eye);
    orl_pose_centre(photo, photo_eye);
    orl_pose_apply(photo, eye, offset);
    orl_pose_apply(view, photo_eye, in_view);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++)
                sum += photo->r[i][k] * view->r[j][k];
            data->from_view[i][j] = (float)sum;
        }
        data->from_view[i][3] = (float)offset[i];
        data->eye[i] = (float)in_view[i];
    }
}

static void set_focal(float out[4], const struct orl_camera *c)
{
    out[0] = (float)c->fx;
    out[1] = (float)c->fy;
    out[2] = (float)c->cx;
    out[3] = (float)c->cy;
}

static void describe_photo(const struct photos *photos, size_t index, const struct orl_view *view,
                           bool aligned, struct photo_data *data)
{
    const struct orl_photo *photo = &photos->scene->photos[index];
    const struct photo_state *state = &photos->states[index];
    relative_pose(&photo->view.cam_from_world, &view->cam_from_world, data);
    data->eye[3] = (float)state->slot;
    set_focal(data->focal, &state->color_camera);
    data->size[0] = (float)state->color_camera.width;
    data->size[1] = (float)state->color_camera.height;
    data->size[2] = (float)state->depth_camera.width;
    data->size[3] = (float)state->depth_camera.height;
    for (int c = 0; c < 3; c++) {
        data->gain[c] = aligned || photos->radiance ? photo->gain[c] : 1;
        data->lens[c] = aligned ? photo->vignette[c] : 0;
    }
    data->lens[3] = 4 / (data->size[0] * data->size[0] + data->size[1] * data->size[1]);
    data->gain[3] = (float)state->slot;
    if (!photos->radiance)
        return;
    for (int c = 0; c < 3; c++)
        data->gain[c] *= state->white;
    // In units of the device's colours.
    data->noise[0] = (float)photos->sensor.shot / state->white;
    data->noise[1] = powf((float)photos->sensor.read / state->white, 2);
    data->noise[2] = state->rounded;
}

static int tiles(int side)
{
    return (side + CHOICE_TILE - 1) / CHOICE_TILE;
}

// What every gather pass is told; writes the photographs of this dispatch.
static struct gather_block prepare_pass(struct orl_renderer *r, const struct orl_view *view,
                                        const struct orl_render_params *params, size_t count)
{
    struct gather *g = &r->gather;
    const struct orl_tex_params *color = &r->photos.color->params;
    const struct orl_tex_params *depth = &r->photos.depth->params;
    for (size_t i = 0; i < count; i++)
        describe_photo(&r->photos, g->chosen[i], view, params->alignment == ORL_ALIGNMENT_ON,
                       &g->list[i]);
    orl_buf_write(g->photos, 0, count * sizeof *g->list, g->list);
    struct gather_block block = {
        .options = {params->depth_tolerance, params->distance_floor,
                    params->border_px / (float)r->photos.divide},
        .flags = {params->visibility == ORL_VISIBILITY_HARD,
                  params->sampling == ORL_SAMPLING_BICUBIC, (int)(params->silhouette + 0.5f)},
        .radiance = {params->ghosts, (float)(r->photos.sensor.model * r->photos.sensor.model),
                     orl_least_radiance(&r->photos.sensor, r->photos.ev_brightest, true)},
        .area = {view->camera.width, view->camera.height, (int)count, tiles(view->camera.width)},
        .choice = {floorf(params->photos_per_pixel + 0.5f), params->sharpness,
                   params->unknown_trust, params->guess_sharpness},
        .choice_more = {floorf(params->candidates + 0.5f),
                        params->outliers > 0 ? 1 / (params->outliers * params->outliers) : 0,
                        (float)(color->levels - 1),
                        orl_fill_guesses(params) ? params->guess_blur : 0},
        .slots = {(float)color->width, (float)color->height, (float)depth->width,
                  (float)depth->height},
    };
    set_focal(block.view_focal, &view->camera);
    memcpy(block.ground, r->fill.block.ground, sizeof block.ground);
    return block;
}

// Room for `bytes` in *buf, which loses what it holds.
static enum orl_result make_room(struct orl_gpu *gpu, const char *tag, size_t bytes,
                                 struct orl_buf **buf)
{
    if (*buf && (*buf)->size >= bytes)
        return ORL_OK;
    orl_buf_destroy(gpu, buf);
    return orl_buf_create(gpu, tag, bytes, NULL, buf);
}

static void run(struct orl_gpu *gpu, const char *pass, const struct orl_dispatch *d)
{
    orl_pass_begin(gpu, pass);
    orl_gpu_dispatch(gpu, d);
    orl_pass_end(gpu);
}

// Lists the photographs of each group of pixels; the rest of the dispatch as for the gather.
static enum orl_result choose_radiance(struct orl_renderer *r, enum orl_blend blend,
                                       struct orl_dispatch d)
{
    size_t across = d.groups[0], down = d.groups[1];
    enum orl_result result =
        make_room(r->gpu, "photographs of tiles",
                  across * down * ORL_RADIANCE_LIST * sizeof(int), &r->gather.tile_lists);
    if (result != ORL_OK)
        return result;
    d.prog = r->gather.choose_radiance[blend];
    d.bufs[1].buf = r->gather.tile_lists;
    d.groups[0] = orl_groups(across, 8);
    d.groups[1] = orl_groups(down, 8);
    d.barrier = GL_SHADER_STORAGE_BARRIER_BIT;
    run(r->gpu, "choose", &d);
    return ORL_OK;
}

static enum orl_result gather_all(struct orl_renderer *r, const struct orl_view *view,
                                  const struct orl_render_params *params, size_t count)
{
    struct gather_block block = prepare_pass(r, view, params, count);
    struct orl_dispatch d = {.prog = r->gather.all[params->sampling], .params = &block,
                             .textures = {r->photos.color, r->photos.depth},
                             .images = {{r->target.depth, 0, GL_READ_ONLY},
                                        {r->accumulated, 0, GL_READ_WRITE},
                                        {r->trusted, 0, GL_READ_WRITE},
                                        [PHOTO_ROWS] = {r->gather.photo_rows, 0, GL_READ_ONLY}},
                             // Storage: the next turn's choice overwrites this one's lists.
                             .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                        GL_SHADER_STORAGE_BARRIER_BIT};
    orl_pixel_groups(view->camera.width, view->camera.height, d.groups);
    if (r->photos.radiance) {
        enum orl_result result = choose_radiance(r, params->blend, d);
        if (result != ORL_OK)
            return result;
        d.prog = r->gather.radiance[params->blend];
        d.bufs[1].buf = r->gather.tile_lists;
    }
    run(r->gpu, "gather", &d);
    return ORL_OK;
}

static enum orl_result gather_best(struct orl_renderer *r, const struct orl_view *view,
                                   const struct orl_render_params *params, size_t count)
{
    struct gather *g = &r->gather;
    int across = tiles(view->camera.width), down = tiles(view->camera.height);
    unsigned groups[3]; // 2x2 pixels an invocation
    orl_pixel_groups((view->camera.width + 1) / 2, (view->camera.height + 1) / 2, groups);
    static const uint32_t nothing[4] = {0, 1, 1, 0}; // shaders/gather/unfinished.glsl
    enum orl_result result =
        make_room(r->gpu, "photographs of tiles",
                  (size_t)across * (size_t)down * CANDIDATES * sizeof(int), &g->tile_lists);
    if (result == ORL_OK)
        result = make_room(r->gpu, "groups with unfinished pixels",
                           sizeof nothing + 8 * (size_t)groups[0] * groups[1], &g->unfinished);
    if (result != ORL_OK)
        return result;
    orl_buf_fill(g->unfinished, 0);
    orl_buf_write(g->unfinished, 0, sizeof nothing, nothing);
    if (count == 0) {
        orl_tex_clear(r->accumulated, 0);
        return ORL_OK;
    }
    struct gather_block block = prepare_pass(r, view, params, count);
    struct orl_dispatch d = {.prog = g->choose, .params = &block,
                             .bufs = {[1] = {.buf = g->tile_lists}, {.buf = g->unfinished}},
                             .textures = {r->photos.color, r->photos.depth},
                             .images = {{r->target.depth, 0, GL_READ_ONLY},
                                        [PHOTO_ROWS] = {g->photo_rows, 0, GL_READ_ONLY}},
                             .groups = {orl_groups((size_t)across, 8), orl_groups((size_t)down, 8)},
                             .barrier = GL_SHADER_STORAGE_BARRIER_BIT};
    run(r->gpu, "choose", &d);
    if (block.flags[2] > 0)
        orl_edges_cut(r->gpu, &r->edges, &d, &r->target);
    d.prog = g->best[params->sampling][block.choice[0] > 2];
    d.images[1] = (struct orl_image_binding){r->accumulated, 0, GL_WRITE_ONLY};
    d.images[2] = (struct orl_image_binding){r->fill.level[0], 0, GL_WRITE_ONLY};
    d.images[3] = (struct orl_image_binding){r->soften.guesses, 0, GL_WRITE_ONLY};
    d.barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                GL_COMMAND_BARRIER_BIT;
    memcpy(d.groups, groups, sizeof groups);
    orl_tex_clear(r->soften.guesses, 0);
    run(r->gpu, "gather", &d);
    return ORL_OK;
}

// Paints from all usable photographs, as many at once as are resident together.
static enum orl_result blend_all(struct orl_renderer *r, const struct orl_view *view,
                                 const struct orl_render_params *params,
                                 const struct proxy_options *depth_options, const bool *skip)
{
    size_t count = 0;
    orl_accumulated_clear(r);
    for (size_t i = 0; i < r->scene->photo_count; i++) {
        if (!r->photos.states[i].usable || (skip && skip[i]))
            continue;
        enum orl_result result = ORL_OK;
        if (count == (size_t)r->photos.slot_count) {
            result = gather_all(r, view, params, count);
            count = 0;
        }
        if (result == ORL_OK)
            result = orl_photos_require(r->gpu, &r->photos, &r->proxy, i, depth_options);
        if (result != ORL_OK)
            return result;
        r->gather.chosen[count++] = i;
    }
    return count ? gather_all(r, view, params, count) : ORL_OK;
}

// Paints from the photographs that this view can use best; the rest need not be resident.
static enum orl_result blend_best(struct orl_renderer *r, const struct orl_view *view,
                                  const struct orl_render_params *params,
                                  const struct proxy_options *depth_options, const bool *skip)
{
    size_t most = (size_t)r->photos.slot_count, count = 0;
    most = most < PHOTOS_PER_FRAME_MAX ? most : PHOTOS_PER_FRAME_MAX;
    enum orl_result result = orl_preselect(orl_gpu_log(r->gpu), &r->photos, view, skip, most,
                                           r->gather.chosen, &count);
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        result = orl_photos_require(r->gpu, &r->photos, &r->proxy, r->gather.chosen[i],
                                    depth_options);
    return result == ORL_OK ? gather_best(r, view, params, count) : result;
}

bool orl_blends_at_once(const struct orl_renderer *r, const struct orl_render_params *params)
{
    return params->color == ORL_COLOR_PHOTOS && params->blend == ORL_BLEND_BEST &&
           !r->photos.radiance;
}

enum orl_result orl_gather(struct orl_renderer *r, const struct orl_view *view,
                           const struct orl_render_params *params, const bool *skip)
{
    struct proxy_options options = orl_proxy_options(params);
    // The choice of the best asks what hides the surface even when pixels do not. Radiance
    // needs every exposure: the best by angle alone may all be clipped.
    if (orl_blends_at_once(r, params))
        return blend_best(r, view, params, &options, skip);
    bool test = params->visibility == ORL_VISIBILITY_HARD;
    return blend_all(r, view, params, test ? &options : NULL, skip);
}
