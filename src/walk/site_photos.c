// A site's photographs: JPEGs, thumbnails, and a depth map of each.
#include <math.h>

#include "bridge/bridge.h"
#include "io/picture.h"
#include "oriel/path.h"
#include "render/photos/photos.h"
#include "render/photos/photo_loader.h"
#include "walk/internal.h"

enum {
    THUMB_SIDE = 160,
    THUMB_QUALITY = 70,
    RADIANCE_QUALITY = 100, // logarithms have little contrast, and are stretched when shown
    REPLACED_STOPS = 8, // above white, that photographs of radiance are published up to
    POSTER_WIDTH = 960,
    POSTER_HEIGHT = 600,
    POSTER_QUALITY = 78,
    DEPTH_SIDE_MAX = 1024, // as in the renderer: depth is smooth between edges
    // Depth is stored as round(STEPS_PER_FOLD * ln(z / nearest)) + 1, or 0 where there is none. A
    // step is a twentieth of the tolerance of the occlusion test.
    STEPS_PER_FOLD = 2048,
    DEPTH_MAX = 32767, // the highest bit is left to the page
};

static struct orl_camera within(const struct orl_camera *camera, int side)
{
    int longer = camera->width > camera->height ? camera->width : camera->height;
    if (longer <= side)
        return *camera;
    double scale = (double)side / longer;
    int width = (int)lrint(fmax(1, camera->width * scale));
    int height = (int)lrint(fmax(1, camera->height * scale));
    return orl_camera_resized(camera, width, height);
}

// --- pictures ---

static enum orl_result write_smaller(struct site *site, const struct orl_image *image, int width,
                                     int height, int quality, const char *path)
{
    struct orl_image small = {0};
    bool same = image->width == width && image->height == height;
    enum orl_result result = same ? ORL_OK
                                  : orl_bridge_resize(site->log, image, width, height, &small);
    ORL_THEN(result, orl_jpeg_write(site->log, ORL_PATH(site->dir, "%s", path), same ? image : &small, quality, NULL));
    orl_image_finish(&small);
    return result;
}

static enum orl_result write_thumb(struct site *site, const struct orl_image *image,
                                   const struct orl_camera *camera, const char *path)
{
    struct orl_camera small = within(camera, THUMB_SIDE);
    return write_smaller(site, image, small.width, small.height, THUMB_QUALITY, path);
}

static enum orl_result write_pictures(struct site *site, size_t photo,
                                      const struct orl_camera *camera, const char *picture,
                                      const char *thumb)
{
    struct orl_image image = {0};
    enum orl_result result = orl_photo_read(site->log, site->scene, photo, false, &image);
    ORL_THEN(result, write_smaller(site, &image, camera->width, camera->height, site->params->jpeg_quality, picture));
    if (result == ORL_OK && !*site->folder) // the list of photographs shows the first time step
        result = write_thumb(site, &image, camera, thumb);
    orl_image_finish(&image);
    return result;
}

// --- pictures of radiance ---

struct site_range orl_site_range(const struct orl_scene *scene)
{
    static const double above = 1.25, below_stops = 6; // white, and darkness, of one photograph
    double low = 0, high = 0;
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_photo *photo = &scene->photos[i];
        low = fmin(low, photo->radiance ? -REPLACED_STOPS : photo->exposure_ev);
        high = fmax(high, photo->exposure_ev);
    }
    double peak = above * exp2(-low), mu = exp2(high - low + below_stops);
    return (struct site_range){peak, mu};
}

static enum orl_result encode_radiance(const struct orl_log *log, const struct site_range *range,
                                       const struct orl_image *light, struct orl_image *coded)
{
    enum orl_result result = orl_image_init(log, coded, light->width, light->height, 3,
                                            ORL_PIXEL_U8);
    size_t count = 3 * (size_t)light->width * (size_t)light->height;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        double x = fmin(fmax((double)light->f32[i], 0) / range->peak, 1);
        coded->u8[i] = (uint8_t)lrint(255 * log1p(range->mu * x) / log1p(range->mu));
    }
    return result;
}

// What the renderer makes of all exposures at a photograph's place.
static enum orl_result write_radiance(struct site *site, size_t photo,
                                      const struct orl_camera *camera, const char *picture,
                                      const char *thumb)
{
    const struct orl_view view = {*camera, site->scene->photos[photo].view.cam_from_world};
    struct orl_render_params params = site->render;
    params.leave_out = ORL_LAYER_DEPTH | ORL_LAYER_NORMAL | ORL_LAYER_COVERAGE |
                       ORL_LAYER_CONFIDENCE;
    struct orl_frame frame = {0};
    struct orl_image coded = {0}, shown = {0};
    enum orl_result result = orl_renderer_draw(site->renderer, &view, &params, NULL, &frame);
    ORL_THEN(result, encode_radiance(site->log, &site->range, &frame.color, &coded));
    ORL_THEN(result, write_smaller(site, &coded, camera->width, camera->height, RADIANCE_QUALITY, picture));
    ORL_THEN(result, orl_tone_srgb(site->log, &frame.color, &shown));
    ORL_THEN(result, write_thumb(site, &shown, camera, thumb));
    orl_image_finish(&coded);
    orl_image_finish(&shown);
    orl_frame_finish(&frame);
    return result;
}

// --- depth ---

static float nearest_depth(const struct orl_image *depth)
{
    float nearest = INFINITY;
    size_t count = (size_t)depth->width * (size_t)depth->height;
    for (size_t i = 0; i < count; i++)
        if (depth->f32[i] > 0)
            nearest = fminf(nearest, depth->f32[i]);
    return isfinite(nearest) ? nearest : 1;
}

// The high byte goes to red, the low byte to green.
static enum orl_result pack_depth(const struct orl_log *log, const struct orl_image *depth,
                                  float nearest, struct orl_image *packed)
{
    enum orl_result result = orl_image_init(log, packed, depth->width, depth->height, 3,
                                            ORL_PIXEL_U8);
    size_t count = (size_t)depth->width * (size_t)depth->height;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        float z = depth->f32[i];
        float steps = z > 0 ? STEPS_PER_FOLD * logf(z / nearest) + 1 : 0;
        long value = lrintf(fminf(steps, DEPTH_MAX));
        packed->u8[3 * i] = (uint8_t)(value >> 8);
        packed->u8[3 * i + 1] = (uint8_t)value;
    }
    return result;
}

// Draws the depth of the point cloud, or of the hull in its room, in this camera without any photograph.
// The occlusion test compares with this depth.
static enum orl_result draw_depth(struct site *site, const struct orl_view *view,
                                  struct orl_image *depth)
{
    struct orl_render_params params = site->carves ? site->subject : orl_method_find(site->log, "points")->params;
    params.fill = ORL_FILL_NONE;
    if (!site->carves) {
        params.splat_scale = site->render.splat_scale;
        params.front_layer = site->render.front_layer;
    }
    params.leave_out = ORL_LAYER_NORMAL | ORL_LAYER_COVERAGE | ORL_LAYER_CONFIDENCE;
    struct orl_frame frame;
    ORL_TRY(orl_renderer_draw(site->renderer, view, &params, NULL, &frame));
    *depth = frame.depth;
    frame.depth = (struct orl_image){0};
    orl_frame_finish(&frame);
    if (site->carves)
        orl_site_room_depth(site, view, depth);
    return ORL_OK;
}

// Occluders get the least depth that can be stored.
static enum orl_result put_occluders(const struct site *site, size_t photo, float nearest,
                                     struct orl_image *depth)
{
    struct orl_image mask;
    enum orl_result result = orl_occluders_read(site->log, site->scene, photo, &mask);
    for (int y = 0; result == ORL_OK && mask.height && y < depth->height; y++)
        for (int x = 0; x < depth->width; x++) {
            int row = y * mask.height / depth->height, column = x * mask.width / depth->width;
            if (mask.u8[row * mask.width + column] > 127)
                depth->f32[y * depth->width + x] = nearest;
        }
    orl_image_finish(&mask);
    return result;
}

static enum orl_result write_depth(struct site *site, size_t photo, const struct orl_view *view,
                                   const char *path, float *nearest)
{
    struct orl_image depth = {0}, packed = {0};
    enum orl_result result = draw_depth(site, view, &depth);
    *nearest = result == ORL_OK ? nearest_depth(&depth) : 1;
    ORL_THEN(result, put_occluders(site, photo, *nearest, &depth));
    ORL_THEN(result, pack_depth(site->log, &depth, *nearest, &packed));
    ORL_THEN(result, orl_png_write(site->log, ORL_PATH(site->dir, "%s", path), &packed));
    orl_image_finish(&depth);
    orl_image_finish(&packed);
    return result;
}

// --- the manifest's part ---

static json_t *vector_json(const float v[3])
{
    return json_pack("[f,f,f]", (double)v[0], (double)v[1], (double)v[2]);
}

// Writes what the site shows of a photograph and adds it to the manifest's array.
static enum orl_result write_photo(struct site *site, size_t index, json_t *photos)
{
    const size_t number = json_array_size(photos);
    const struct orl_photo *photo = &site->scene->photos[index];
    struct orl_camera c = within(&photo->view.camera, site->params->photo_side);
    struct orl_view depth_view = {.camera = within(&c, DEPTH_SIDE_MAX),
                                  .cam_from_world = photo->view.cam_from_world};
    const char *picture = ORL_PATH("", "%sphotos/%05zu.jpg", site->folder, number);
    const char *thumb = ORL_PATH("", "thumbs/%05zu.jpg", number);
    const char *depth = ORL_PATH("", "%sdepth/%05zu.png", site->folder, number);
    const char *soft = ORL_PATH("", "soft/%05zu.jpg", number);
    float nearest = 1;
    enum orl_result result = site->params->radiance
                                 ? write_radiance(site, index, &c, picture, thumb)
                                 : write_pictures(site, index, &c, picture, thumb);
    ORL_THEN(result, write_depth(site, index, &depth_view, depth, &nearest));
    if (result == ORL_OK && site->soft.count)
        result = orl_site_soft_photo(site, &(struct orl_view){c, photo->view.cam_from_world}, soft);
    json_t *depth_file = result == ORL_OK ? orl_site_file(site, depth) : NULL;
    if (result != ORL_OK || !depth_file)
        return result != ORL_OK ? result : ORL_ERR_IO;
    json_object_update_new(depth_file,
                           json_pack("{s:i, s:i, s:f, s:i}", "width", depth_view.camera.width,
                                     "height", depth_view.camera.height, "nearest", (double)nearest,
                                     "steps_per_fold", STEPS_PER_FOLD));
    json_t *json = orl_walk_photo(photo, &c);
    // Radiance has the scene's exposure, and no vignetting.
    static const float one[3] = {1, 1, 1}, none[3] = {0};
    bool radiance = site->params->radiance;
    json_t *more = json_pack("{s:o, s:o, s:o, s:o, s:o, s:o*}", "gain",
                             vector_json(radiance ? one : photo->gain), "vignette",
                             vector_json(radiance ? none : photo->vignette), "picture",
                             orl_site_file(site, picture), "thumb", orl_site_file(site, thumb),
                             "depth", depth_file, "soft", site->soft.count ? orl_site_file(site, soft) : NULL);
    bool whole = json_object_update_new(json, more) == 0;
    return json_array_append_new(photos, json) == 0 && whole ? ORL_OK : ORL_ERR_MEMORY;
}

enum orl_result orl_site_photos(struct site *site, json_t **out)
{
    const struct orl_scene *scene = site->scene;
    json_t *photos = *out = json_array();
    enum orl_result result = photos ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        if (scene->photos[i].test)
            continue;
        if (orl_progress_cancelled(site->params->progress))
            result = ORL_ERR_CANCELLED;
        ORL_THEN(result, write_photo(site, i, photos));
        if (!*site->folder)
            orl_progress_report(site->params->progress, "publish", (double)(i + 1),
                                (double)scene->photo_count, scene->photos[i].name);
    }
    site->report->photos += json_array_size(photos);
    return result;
}

enum orl_result orl_site_poster(struct site *site)
{
    struct orl_view view = site->scene->photos[site->start].view;
    struct orl_frame frame;
    struct orl_image srgb = {0};
    (void)orl_walk_settings_start(site->settings, &view.camera, &view);
    view.camera = orl_camera_reframed(&view.camera, POSTER_WIDTH, POSTER_HEIGHT);
    const struct orl_render_params *render = site->carves ? &site->subject : &site->render;
    ORL_TRY(orl_renderer_draw(site->renderer, &view, render, NULL, &frame));
    enum orl_result result = orl_tone_srgb(site->log, &frame.color, &srgb);
    ORL_THEN(result, write_smaller(site, &srgb, POSTER_WIDTH, POSTER_HEIGHT, POSTER_QUALITY, "poster.jpg"));
    orl_image_finish(&srgb);
    orl_frame_finish(&frame);
    return result;
}
