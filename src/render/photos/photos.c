// Photographs and their depth maps on the device, within a memory budget.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "bridge/bridge.h"
#include "core/file.h"
#include "core/memory.h"
#include "io/picture.h"
#include "render/frame/method.h"
#include "render/photos/photos.h"
#include "scene/manifest.h"
#include "scene/silhouette.h"
#include "shared/render_blocks.h"

enum {
    DIVIDE_MAX = 4,
    RESIDENT_ENOUGH = 24,       // photographs that fit at once before they are made smaller
    DEPTH_SIDE_MAX = 1024,      // occlusion tests need no more: depth is smooth between edges
    ARRAY_BYTES_MAX = 1 << 30,  // bytes of one texture array; llvmpipe refuses larger ones
};

static int divided(int side, int divide)
{
    int small = side / divide;
    return small > 1 ? small : 1;
}

static struct orl_camera camera_divided(const struct orl_camera *c, int divide)
{
    return divide > 1 ? orl_camera_resized(c, divided(c->width, divide), divided(c->height, divide)) : *c;
}

// least: the scene's depth_divide
static struct orl_camera depth_camera_of(const struct orl_camera *color, int least)
{
    int side = color->width > color->height ? color->width : color->height;
    int divide = least > 1 ? least : 1;
    while (side / divide > DEPTH_SIDE_MAX)
        divide++;
    return camera_divided(color, divide);
}

// Size of a slot: the maximum of the usable photographs in each direction.
struct slot_size {
    int width, height, depth_width, depth_height;
};

static int larger(int a, int b)
{
    return a > b ? a : b;
}

static struct slot_size slot_size(const struct photos *photos, int divide)
{
    struct slot_size size = {1, 1, 1, 1};
    for (size_t i = 0; i < photos->scene->photo_count; i++) {
        if (!photos->states[i].usable)
            continue;
        struct orl_camera color = camera_divided(&photos->scene->photos[i].view.camera, divide);
        struct orl_camera depth =
            depth_camera_of(&color, photos->scene->defaults.depth_divide);
        size.width = larger(size.width, color.width);
        size.height = larger(size.height, color.height);
        size.depth_width = larger(size.depth_width, depth.width);
        size.depth_height = larger(size.depth_height, depth.height);
    }
    return size;
}

// A texture of all slots.
static struct orl_tex_params array_params(const struct slot_size *size, int layers, GLenum format, const char *tag)
{
    bool chroma = format == GL_COMPRESSED_RG_RGTC2; // of textures=ycc
    int width = chroma ? (size->width + 1) / 2 : size->width;
    int height = chroma ? (size->height + 1) / 2 : size->height;
    return (struct orl_tex_params){.width = width, .height = height, .layers = layers,
                                   .levels = orl_mip_levels(width, height), .format = format, .linear = true,
                                   .owner = ORL_OWNER_PHOTOGRAPHS, .tag = tag};
}

static bool has_chroma(GLenum format)
{
    return format == GL_COMPRESSED_RED_RGTC1;
}

// Of a slot, with its chroma.
static size_t color_bytes(const struct slot_size *size, GLenum format)
{
    const struct orl_tex_params color = array_params(size, 1, format, NULL);
    const struct orl_tex_params chroma = array_params(size, 1, GL_COMPRESSED_RG_RGTC2, NULL);
    return orl_tex_layer_bytes(&color) + (has_chroma(format) ? orl_tex_layer_bytes(&chroma) : 0);
}

static bool is_compressed(const struct photos *photos)
{
    return photos->format != GL_RGBA8 && photos->format != GL_RGBA16F;
}

// The part of the budget that is available for slots.
static size_t slot_budget(const struct photos *photos, const struct slot_size *size, size_t budget)
{
    size_t loading = is_compressed(photos) ? color_bytes(size, GL_RGBA8) : 0;
    return budget > loading ? budget - loading : 1;
}

// Of everything that a method may ask for.
static size_t slot_bytes(const struct photos *photos, const struct slot_size *size)
{
    return color_bytes(size, photos->format) +
           (size_t)size->depth_width * (size_t)size->depth_height *
               (photos->scene->defaults.depth_half ? 2 : 4) +
           (photos->silhouettes + photos->soft_splats) * color_bytes(size, GL_R8) +
           (photos->places ? color_bytes(size, GL_RGBA8) : 0);
}

static bool fits_all(const struct photos *photos, const struct slot_size *size, int count,
                     size_t budget)
{
    return slot_bytes(photos, size) * (size_t)count <= slot_budget(photos, size, budget);
}

// Plans within the budget: compresses photographs first, then makes fewer resident, down to
// RESIDENT_ENOUGH, then loads them smaller, then makes still fewer resident.
static struct slot_size plan(struct orl_gpu *gpu, size_t budget, enum orl_textures textures,
                             struct photos *photos)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    int layers_max = orl_gpu_caps(gpu)->max_texture_layers;
    int count = 0, asked = photos->divide;
    for (size_t i = 0; i < photos->scene->photo_count; i++)
        count += photos->states[i].usable;
    struct slot_size size = slot_size(photos, photos->divide);
    photos->format = orl_textures_format(gpu, photos->radiance, textures);
    if (textures == ORL_TEXTURES_AUTO && !photos->radiance && budget &&
        !fits_all(photos, &size, count, budget)) {
        photos->format = orl_textures_format(gpu, false, ORL_TEXTURES_YCC);
        if (is_compressed(photos))
            orl_logf(log, ORL_LOG_WARNING, "photographs do not fit in %zu MiB of device memory: "
                     "compressing them", budget >> 20);
    }
    // A view is painted from a few photographs: a few sharp ones are worth more than many blurred.
    int enough = count < RESIDENT_ENOUGH ? count : RESIDENT_ENOUGH;
    while (budget && photos->divide < DIVIDE_MAX && !fits_all(photos, &size, enough, budget)) {
        photos->divide *= 2;
        size = slot_size(photos, photos->divide);
    }
    size_t fits = budget ? slot_budget(photos, &size, budget) / slot_bytes(photos, &size)
                         : (size_t)count;
    size_t array_fits = ARRAY_BYTES_MAX / color_bytes(&size, photos->format);
    fits = fits < array_fits ? fits : array_fits;
    fits = fits < (size_t)layers_max ? fits : (size_t)layers_max;
    fits = fits < (size_t)count ? fits : (size_t)count;
    photos->slot_count = fits > 1 ? (int)fits : 1;
    if (photos->divide > asked)
        orl_logf(log, ORL_LOG_WARNING,
                 "photographs do not fit in %zu MiB of device memory: using them at 1/%d size",
                 budget >> 20, photos->divide);
    if (photos->slot_count < count)
        orl_logf(log, ORL_LOG_WARNING,
                 "keeping %d of %d photographs on the device at once; frames get slower",
                 photos->slot_count, count);
    return size;
}

// Exposure of a photograph in stops above the scene's middle exposure.
static float photo_ev(const struct orl_photo *photo)
{
    return -log2f(photo->gain[0] * photo->gain[1] * photo->gain[2]) / 3;
}

// Finds the range of exposures of the photographs in use: the darkest photograph clips last, and
// the brightest one resolves the darkest light.
static void find_exposures(struct photos *photos)
{
    bool first = true;
    for (size_t i = 0; i < photos->scene->photo_count; i++) {
        float ev = photo_ev(&photos->scene->photos[i]);
        if (!photos->states[i].usable)
            continue;
        photos->ev_darkest = first || ev < photos->ev_darkest ? ev : photos->ev_darkest;
        photos->ev_brightest = first || ev > photos->ev_brightest ? ev : photos->ev_brightest;
        first = false;
    }
}

enum orl_result orl_photos_init(struct orl_gpu *gpu, const struct orl_scene *scene,
                                const struct orl_renderer_params *params, size_t budget_bytes,
                                struct photos *photos)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    const bool *use = params->use;
    memset(photos, 0, sizeof *photos);
    photos->scene = scene;
    photos->time_step = scene->frame;
    photos->radiance = params->radiance;
    photos->progress = params->progress;
    photos->sensor = params->sensor ? *params->sensor
                                    : (struct orl_sensor){ORL_SENSOR_DEFAULTS};
    photos->states = orl_array(log, scene->photo_count, sizeof *photos->states);
    ORL_TRY_MEMORY(photos->states);
    for (size_t i = 0; i < scene->photo_count; i++) {
        photos->states[i].usable = photos->states[i].asked = use ? use[i] : !scene->photos[i].test;
        photos->states[i].slot = -1;
    }
    find_exposures(photos);
    for (size_t i = 0; i < scene->photo_count; i++)
        photos->silhouettes |= photos->states[i].usable && scene->photos[i].masked;
    photos->places = orl_photos_backgrounds(photos);
    photos->soft_splats = !photos->radiance && orl_path_is_file(ORL_PATH(scene->dir, ORL_SOFT_NAME));
    photos->divide = params->photo_divide > 1 ? params->photo_divide : 1;
    enum orl_textures textures = ORL_TEXTURES_AUTO;
    ORL_TRY(orl_textures_choose(log, scene, params, &textures));
    struct slot_size size = plan(gpu, budget_bytes, textures, photos);
    photos->background_of = orl_array(log, (size_t)photos->slot_count, sizeof *photos->background_of);
    ORL_TRY_MEMORY(photos->background_of);
    for (size_t i = 0; i < scene->photo_count; i++) {
        struct photo_state *state = &photos->states[i];
        state->color_camera = camera_divided(&scene->photos[i].view.camera, photos->divide);
        state->depth_camera = depth_camera_of(&state->color_camera, scene->defaults.depth_divide);
        state->drawn_camera = depth_camera_of(&state->color_camera, 1);
    }
    photos->color_params = array_params(&size, photos->slot_count, photos->format, "photographs");
    photos->depth_params = (struct orl_tex_params){
        .width = size.depth_width, .height = size.depth_height, .layers = photos->slot_count,
        .format = scene->defaults.depth_half ? GL_R16F : GL_R32F,
        .owner = ORL_OWNER_PHOTOGRAPHS, .tag = "photograph depth"};
    const struct orl_tex_params chroma =
        array_params(&size, photos->slot_count, GL_COMPRESSED_RG_RGTC2, "photograph chroma");
    ORL_TRY(orl_tex_create(gpu, &photos->color_params, &photos->color));
    return has_chroma(photos->format) ? orl_tex_create(gpu, &chroma, &photos->chroma) : ORL_OK;
}

void orl_photos_finish(struct orl_gpu *gpu, struct photos *photos)
{
    orl_photo_loader_destroy(&photos->loader);
    orl_tex_destroy(gpu, &photos->color);
    orl_tex_destroy(gpu, &photos->chroma);
    orl_tex_destroy(gpu, &photos->depth);
    orl_tex_destroy(gpu, &photos->loading);
    orl_tex_destroy(gpu, &photos->soft);
    orl_tex_destroy(gpu, &photos->mask);
    orl_tex_destroy(gpu, &photos->background);
    free(photos->background_of);
    free(photos->states);
    memset(photos, 0, sizeof *photos);
}

static struct photo_state *state_in_slot(struct photos *photos, int slot)
{
    for (size_t i = 0; i < photos->scene->photo_count; i++)
        if (photos->states[i].slot == slot)
            return &photos->states[i];
    return NULL;
}

static void evict(struct photo_state *state)
{
    state->slot = -1;
    state->depth_divide = 0;
    state->has_color = state->has_mask = state->has_soft = false;
}

// Returns a free slot, or else evicts the least recently used photograph. There is at least one slot.
static int take_slot(struct photos *photos)
{
    struct photo_state *oldest = NULL;
    int taken = 0;
    for (int slot = 0; slot < photos->slot_count; slot++) {
        struct photo_state *state = state_in_slot(photos, slot);
        if (!state)
            return slot;
        if (!oldest || state->last_use < oldest->last_use) {
            oldest = state;
            taken = slot;
        }
    }
    if (oldest)
        evict(oldest);
    return taken;
}

static void give_slot(struct photos *photos, struct photo_state *state)
{
    state->last_use = ++photos->clock;
    if (state->slot < 0)
        state->slot = take_slot(photos);
}

void orl_photos_follow_time_step(struct photos *photos)
{
    if (photos->time_step == photos->scene->frame)
        return;
    orl_photo_loader_destroy(&photos->loader); // what it has read is of the other time step
    for (size_t i = 0; i < photos->scene->photo_count; i++) {
        evict(&photos->states[i]);
        photos->states[i].usable = photos->states[i].asked;
    }
    photos->time_step = photos->scene->frame;
}

// Of a photograph smaller than its slot, what is beside it would bleed into the mipmaps.
static void clear_beside(int width, int height, struct orl_tex *tex, int layer)
{
    if (width < tex->params.width || height < tex->params.height)
        orl_tex_clear(tex, layer);
}

// Writes sRGB-encoded RGB, or radiance times confidence, and the confidence.
static void write_pixels(const struct orl_image *image, struct orl_tex *tex, int layer)
{
    bool radiance = image->type == ORL_PIXEL_F32;
    clear_beside(image->width, image->height, tex, layer);
    orl_tex_write_layer(tex, layer, image->width, image->height, radiance ? GL_RGBA : GL_RGB,
                        radiance ? GL_FLOAT : GL_UNSIGNED_BYTE, image->data);
}

// Loads a photograph smaller: a mip level of the full one, box-filtered in linear light.
static enum orl_result upload_smaller(struct orl_gpu *gpu, const struct orl_image *image,
                                      int divide, struct orl_tex *to, int slot)
{
    struct orl_tex *full = NULL;
    struct orl_tex_params params = {.width = image->width, .height = image->height,
                                    .levels = orl_mip_levels(image->width, image->height),
                                    .format = to->params.format,
                                    .owner = ORL_OWNER_PHOTOGRAPHS, .tag = "photograph"};
    ORL_TRY(orl_tex_create(gpu, &params, &full));
    int level = 0;
    while (1 << level < divide && level + 1 < params.levels)
        level++;
    write_pixels(image, full, 0);
    orl_tex_make_mipmaps(full, 0);
    const int width = divided(image->width, divide), height = divided(image->height, divide);
    clear_beside(width, height, to, slot);
    orl_tex_copy_layer(full, level, width, height, to, slot);
    orl_tex_destroy(gpu, &full);
    return ORL_OK;
}

// Converts a photograph as read into radiance times confidence, and the confidence.
static enum orl_result make_radiance(const struct orl_log *log, struct photos *photos, size_t index,
                                     struct orl_image *image)
{
    const struct orl_scene *scene = photos->scene;
    const struct orl_photo *photo = &scene->photos[index];
    struct orl_photo_response response = {
        .sensor = &photos->sensor, .ev_above = photo_ev(photo) - photos->ev_darkest,
        .linear = photo->response >= 0 ? scene->responses[photo->response].linear : NULL,
        .centre = {(float)photo->view.camera.cx, (float)photo->view.camera.cy},
        .unclipped = photo->radiance,
    };
    memcpy(response.vignette, photo->vignette, sizeof response.vignette);
    struct orl_image radiance;
    struct photo_state *state = &photos->states[index];
    state->rounded = image->type == ORL_PIXEL_U8;
    ORL_TRY(orl_radiance_decode(log, &response, image, &radiance, &state->white));
    size_t count = (size_t)radiance.width * (size_t)radiance.height;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            radiance.f32[4 * i + c] *= (float)ORL_RADIANCE_SCALE;
    orl_image_finish(image);
    *image = radiance;
    return ORL_OK;
}

// Makes the texture in which photographs are complete before they are compressed.
static enum orl_result make_loading(struct orl_gpu *gpu, struct photos *photos)
{
    if (photos->loading)
        return ORL_OK;
    struct orl_tex_params params = photos->color_params;
    params.layers = 0;
    params.format = GL_RGBA8;
    params.tag = "photograph being loaded";
    return orl_tex_create(gpu, &params, &photos->loading);
}

// Once every photograph has its colours, none will be loaded again.
static void drop_loading(struct orl_gpu *gpu, struct photos *photos)
{
    for (size_t i = 0; i < photos->scene->photo_count; i++)
        if (photos->states[i].usable && !photos->states[i].has_color)
            return;
    orl_tex_destroy(gpu, &photos->loading);
}

enum orl_result orl_photos_put(struct orl_gpu *gpu, struct photos *photos, size_t index,
                               struct orl_image *image)
{
    if (photos->radiance)
        ORL_TRY(make_radiance(orl_gpu_log(gpu), photos, index, image));
    if (is_compressed(photos))
        ORL_TRY(make_loading(gpu, photos));
    struct photo_state *state = &photos->states[index];
    give_slot(photos, state);
    // Coarser levels are made before compression, so that compression errors do not accumulate.
    struct orl_tex *to = photos->loading ? photos->loading : photos->color;
    int layer = photos->loading ? 0 : state->slot;
    if (photos->divide > 1)
        ORL_TRY(upload_smaller(gpu, image, photos->divide, to, layer));
    else
        write_pixels(image, to, layer);
    orl_tex_make_mipmaps(to, layer);
    if (photos->loading)
        ORL_TRY(orl_tex_compress_layer(gpu, photos->loading, photos->color, state->slot));
    if (photos->chroma)
        ORL_TRY(orl_tex_compress_layer(gpu, photos->loading, photos->chroma, state->slot));
    state->has_color = true;
    drop_loading(gpu, photos);
    photos->uploaded += orl_image_bytes(image);
    return ORL_OK;
}

static enum orl_result load_color(const struct frame *frame, size_t index)
{
    struct photos *photos = frame->photos;
    struct orl_image image = {0};
    enum orl_result result = ORL_OK;
    if (!photos->ahead ||
        orl_photo_loader_take(photos->ahead, index, true, &image) != PHOTO_READ)
        result = orl_photo_read(orl_gpu_log(frame->gpu), photos->scene, index, photos->radiance,
                                &image);
    ORL_THEN(result, orl_photos_put(frame->gpu, photos, index, &image));
    orl_image_finish(&image);
    return result;
}

struct orl_camera orl_photos_depth_camera(const struct photo_state *state, int divide)
{
    return camera_divided(&state->depth_camera, divide);
}

static bool has_shadow_maps(const struct frame *frame)
{
    return orl_render_params_equal(frame->params, "visibility=opaque");
}

// Keeps kept[] pixels of the depth that a photograph sees in a slot, with estimated depth in the holes, or as a shadow
// map with fat outlines.
static void write_depth(const struct frame *frame, const struct surface *surface, const int kept[2], int slot)
{
    const char *file = has_shadow_maps(frame) ? "proxy/fatten.comp" : "proxy/photo_holes.comp";
    struct depth_map_block block = {.drawn_size = {surface->width, surface->height},
                                    .kept_size = {kept[0], kept[1]},
                                    // Twice what the shadow test allows.
                                    .line_offset = 1 + 2 * frame->params->depth_tolerance};
    orl_gpu_dispatch(frame->gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, file, NULL, NULL), ORL_PARAMS(block),
        .images = {surface->depth, frame->photos->depth}, .layer = slot, .size = {kept[0], kept[1]}});
}

uint64_t orl_photos_depth_key(const struct frame *frame)
{
    const float tolerance = frame->params->depth_tolerance;
    uint64_t key = orl_proxy_key(frame->proxy, frame->params);
    return has_shadow_maps(frame) ? XXH3_64bits_withSeed(&tolerance, sizeof tolerance, key)
                                  : key;
}

enum orl_result orl_photos_draw_depth(const struct frame *frame, size_t index, int divide)
{
    struct photos *photos = frame->photos;
    struct photo_state *state = &photos->states[index];
    const struct orl_camera camera = orl_photos_depth_camera(state, divide);
    const int kept[2] = {camera.width, camera.height};
    // Splats and their holes want pixels: a map that is kept smaller is made from a whole one.
    struct orl_view view = {.camera = divide > 1 ? camera : state->drawn_camera,
                            .cam_from_world = photos->scene->photos[index].view.cam_from_world};
    struct surface surface;
    void **target = divide > 1 ? &frame->proxy->coarse_target : &frame->proxy->photo_target;
    if (!photos->depth)
        ORL_TRY(orl_tex_create(frame->gpu, &photos->depth_params, &photos->depth));
    ORL_TRY(orl_proxy_draw(frame->gpu, frame->proxy, &view, frame->params, false, target, &surface));
    write_depth(frame, &surface, kept, state->slot);
    if (!has_shadow_maps(frame))
        ORL_TRY(orl_occluders_put(frame, index, kept));
    state->depth_key = frame->photos->depth_key;
    state->depth_divide = divide;
    return ORL_OK;
}

int orl_photos_depth_divide(const struct frame *frame, size_t photo)
{
    const struct photo_state *state = &frame->photos->states[photo];
    return state->depth_key == frame->photos->depth_key ? state->depth_divide : 0;
}

enum orl_result orl_photos_require(const struct frame *frame, size_t photo, bool depth)
{
    struct photos *photos = frame->photos;
    struct photo_state *state = &photos->states[photo];
    if (orl_progress_cancelled(photos->progress))
        return ORL_ERR_CANCELLED;
    give_slot(photos, state);
    if (!state->has_color)
        ORL_TRY(load_color(frame, photo));
    if (depth && orl_photos_depth_divide(frame, photo) != 1)
        ORL_TRY(orl_photos_draw_depth(frame, photo, 1));
    return ORL_OK;
}

enum orl_result orl_photos_array(struct orl_gpu *gpu, const struct photos *photos, GLenum format, const char *tag,
                                 struct orl_tex **tex)
{
    struct orl_tex_params params = photos->color_params;
    params.format = format;
    params.tag = tag;
    return *tex ? ORL_OK : orl_tex_create(gpu, &params, tex);
}

// --- what lies behind the subject ---

bool orl_photos_backgrounds(const struct photos *photos)
{
    const struct orl_scene *scene = photos->scene;
    bool all = !photos->radiance;
    for (size_t i = 0; all && i < scene->photo_count; i++)
        all = !photos->states[i].usable || orl_path_is_file(orl_scene_file(scene, i, ORL_FILE_BACKGROUND).text);
    return all;
}

bool orl_photos_has_background(const struct photos *photos, size_t photo)
{
    return photos->background_of[photos->states[photo].slot] == photo + 1;
}

enum orl_result orl_photos_require_background(const struct frame *frame, size_t photo)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    struct photos *photos = frame->photos;
    struct photo_state *state = &photos->states[photo];
    struct orl_image whole = {0}, image = {0};
    give_slot(photos, state);
    if (orl_photos_has_background(photos, photo))
        return ORL_OK;
    enum orl_result result =
        orl_picture_read(log, orl_scene_file(photos->scene, photo, ORL_FILE_BACKGROUND).text, 3, &whole);
    // Radiance is read without decoding.
    ORL_THEN(result, orl_photos_array(frame->gpu, photos, photos->radiance ? GL_SRGB8_ALPHA8 : GL_RGBA8,
                                      "backgrounds", &photos->background));
    ORL_THEN(result, orl_bridge_resize(log, &whole, state->color_camera.width, state->color_camera.height, &image));
    if (result == ORL_OK) {
        write_pixels(&image, photos->background, state->slot);
        orl_tex_make_mipmaps(photos->background, state->slot);
        photos->background_of[state->slot] = photo + 1;
    }
    orl_image_finish(&whole);
    orl_image_finish(&image);
    return result;
}

// --- masks ---

// The alpha of a photograph at its resident size.
static enum orl_result make_alpha(const struct frame *frame, size_t index,
                                  struct orl_image *alpha)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    const struct photos *photos = frame->photos;
    const struct orl_camera *c = &photos->states[index].color_camera;
    struct orl_image mask = {0};
    if (!photos->scene->photos[index].masked) {
        enum orl_result result =
            orl_image_init(log, alpha, c->width, c->height, 1, ORL_PIXEL_U8);
        if (result == ORL_OK)
            memset(alpha->u8, ORL_ALPHA_IN, orl_image_bytes(alpha));
        return result;
    }
    enum orl_result result = ORL_OK;
    if (photos->masks_ahead && photos->masks_ahead[index].data) {
        mask = photos->masks_ahead[index];
        photos->masks_ahead[index] = (struct orl_image){0};
    } else {
        result = orl_photo_mask_read(log, photos->scene, index, &mask);
    }
    if (result == ORL_OK) {
        orl_silhouette_mark_edges(&mask);
        result = orl_bridge_resize(log, &mask, c->width, c->height, alpha);
    }
    orl_image_finish(&mask);
    return result;
}

enum orl_result orl_photos_require_mask(const struct frame *frame, size_t photo)
{
    struct photos *photos = frame->photos;
    struct photo_state *state = &photos->states[photo];
    struct orl_image alpha = {0};
    if (state->has_mask)
        return ORL_OK;
    enum orl_result result = orl_photos_array(frame->gpu, photos, GL_R8, "photograph masks", &photos->mask);
    ORL_THEN(result, make_alpha(frame, photo, &alpha));
    if (result == ORL_OK) {
        clear_beside(alpha.width, alpha.height, photos->mask, state->slot);
        orl_tex_write_layer(photos->mask, state->slot, alpha.width, alpha.height, GL_RED,
                            GL_UNSIGNED_BYTE, alpha.data);
        orl_tex_make_mipmaps(photos->mask, state->slot);
        photos->uploaded += orl_image_bytes(&alpha);
        state->has_mask = true;
    }
    orl_image_finish(&alpha);
    return result;
}
