// Scenes in which something is left out, ready to render.
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "bridge/bridge.h"
#include "core/color.h"
#include "core/file.h"
#include "core/memory.h"
#include "eval/trim_internal.h"
#include "io/picture.h"

const double orl_trim_point_shares[TRIM_POINT_LEVELS] = {
    1,    0.9,  0.8, 0.72, 0.65,  0.57, 0.5, 0.45, 0.4,  0.36, 0.32, 0.28, 0.25,
    0.22, 0.2, 0.18, 0.16, 0.14, 0.125, 0.11, 0.1, 0.09, 0.08, 0.07, 0.0625};
const double orl_trim_scales[TRIM_SCALE_LEVELS] = {1, 0.875, 0.75, 0.5};
const int orl_trim_qualities[TRIM_QUALITY_LEVELS] = {0, 95, 90, 80};
// Quality of photographs that are made smaller and would otherwise stay as they are.
enum { RESIZED_QUALITY = 95 };

static const struct {
    int divide;
    bool half;
} depth_levels[TRIM_DEPTH_LEVELS] = {{1, false}, {1, true}, {2, true}, {3, true}, {4, true}};

enum orl_result orl_trim_state_copy(const struct orl_log *log, const struct trim_state *from,
                                    size_t photo_count, struct trim_state *to)
{
    *to = *from;
    to->removed = orl_array(log, photo_count, sizeof *to->removed);
    if (!to->removed)
        return ORL_ERR_MEMORY;
    memcpy(to->removed, from->removed, photo_count * sizeof *to->removed);
    return ORL_OK;
}

// --- photographs ---

// Averages in linear light.
static enum orl_result shrink(const struct orl_log *log, const struct orl_image *from, int width,
                              int height, struct orl_image *to)
{
    struct orl_image linear = {0}, small = {0};
    enum orl_result result =
        orl_image_init(log, &linear, from->width, from->height, 3, ORL_PIXEL_F32);
    size_t count = 3 * (size_t)from->width * (size_t)from->height;
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        linear.f32[i] = orl_srgb_decode((float)from->u8[i] / 255);
    if (result == ORL_OK)
        result = orl_bridge_resize(log, &linear, width, height, &small);
    if (result == ORL_OK)
        result = orl_tone_srgb(log, &small, to);
    orl_image_finish(&linear);
    orl_image_finish(&small);
    return result;
}

static struct orl_camera camera_at(const struct orl_camera *camera, size_t scale)
{
    double s = orl_trim_scales[scale];
    return scale ? orl_camera_resized(camera, (int)(camera->width * s + 0.5),
                                      (int)(camera->height * s + 0.5))
                 : *camera;
}

static enum orl_result make_photo(const struct trim_source *source, size_t photo, size_t scale,
                                  size_t quality, const char *dir)
{
    const struct orl_log *log = source->log;
    const struct orl_photo *p = &source->scene->photos[photo];
    const struct orl_camera camera = camera_at(&p->view.camera, scale);
    struct orl_image full = {0}, small = {0};
    char *from = orl_scene_photo_path(log, source->scene, photo);
    char *to = orl_path_join(log, dir, p->name);
    int level = orl_trim_qualities[quality] ? orl_trim_qualities[quality] : RESIZED_QUALITY;
    enum orl_result result = from && to ? orl_picture_read(log, from, 3, &full) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_file_make_folder(log, to); // names may have folders
    if (result == ORL_OK && scale)
        result = shrink(log, &full, camera.width, camera.height, &small);
    const struct orl_image *image = scale ? &small : &full;
    if (result == ORL_OK)
        result = orl_picture_is_png(p->name) ? orl_png_write(log, to, image)
                                 : orl_jpeg_write(log, to, image, level, NULL);
    orl_image_finish(&full);
    orl_image_finish(&small);
    free(from);
    free(to);
    return result;
}

enum orl_result orl_trim_make_photos(const struct trim_source *source, size_t scale,
                                     size_t quality, char **dir)
{
    const struct orl_log *log = source->log;
    *dir = scale || quality
               ? orl_format(log, "%s/%d-%d", source->work, (int)(100 * orl_trim_scales[scale]),
                            orl_trim_qualities[quality])
               : orl_strdup(log, source->scene->dir);
    if (!*dir)
        return ORL_ERR_MEMORY;
    if ((!scale && !quality) || orl_path_is_dir(*dir))
        return ORL_OK;
    char *images = orl_path_join(log, *dir, "images");
    enum orl_result result = images ? orl_dir_make(log, images) : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < source->scene->photo_count; i++)
        if (!source->scene->photos[i].test)
            result = make_photo(source, i, scale, quality, images);
    free(images);
    return result;
}

size_t orl_trim_photo_file_bytes(const struct trim_source *source, const char *dir,
                                 const bool *removed)
{
    size_t bytes = 0;
    for (size_t i = 0; i < source->scene->photo_count; i++) {
        struct stat status;
        char *path = NULL;
        if (source->scene->photos[i].test || (removed && removed[i]))
            continue;
        path = orl_format(source->log, "%s/images/%s", dir, source->scene->photos[i].name);
        bytes += path && stat(path, &status) == 0 ? (size_t)status.st_size : 0;
        free(path);
    }
    return bytes;
}

// --- models ---

struct orl_scene_defaults orl_trim_defaults(const struct trim_source *source,
                                            const struct trim_state *state)
{
    struct orl_scene_defaults defaults = source->scene->defaults;
    if (state->textures != ORL_TEXTURES_AUTO)
        defaults.textures = (char *)orl_textures_names[state->textures];
    if (state->depth) {
        int divide = depth_levels[state->depth].divide;
        defaults.depth_half = depth_levels[state->depth].half;
        defaults.depth_divide = defaults.depth_divide > divide ? defaults.depth_divide : divide;
    }
    return defaults;
}

void orl_trim_count_bytes(const struct orl_gpu *gpu, size_t *points, size_t *photos)
{
    struct orl_gpu_memory rows[64];
    size_t count = orl_gpu_memory(gpu, rows, ORL_COUNT(rows));
    *points = *photos = 0;
    for (size_t i = 0; i < count && i < ORL_COUNT(rows); i++) {
        if (rows[i].owner == ORL_OWNER_POINTS)
            *points += rows[i].bytes;
        else if (rows[i].owner == ORL_OWNER_PHOTOGRAPHS &&
                 strcmp(rows[i].tag, "photograph being loaded") != 0)
            *photos += rows[i].bytes;
    }
}

static enum orl_result set_photos(const struct trim_source *source, const struct trim_state *state,
                                  struct trim_model *model)
{
    struct orl_scene *scene = &model->scene;
    scene->photos = orl_array(source->log, scene->photo_count, sizeof *scene->photos);
    if (!scene->photos)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < scene->photo_count; i++) {
        scene->photos[i] = source->scene->photos[i]; // its name stays the source's
        if (!scene->photos[i].test)
            scene->photos[i].view.camera =
                camera_at(&scene->photos[i].view.camera, state->scale);
    }
    enum orl_result result =
        orl_trim_make_photos(source, state->scale, state->quality, &model->dir);
    scene->dir = model->dir;
    return result;
}

// Draws a small frame, since depth maps and masks of photographs take memory only once a method has
// asked for them.
static enum orl_result draw_first_frame(const struct trim_source *source,
                                        const struct trim_state *state,
                                        const struct trim_model *model)
{
    enum { SIDE = 64 };
    size_t photo = 0;
    while (photo + 1 < model->scene.photo_count &&
           (model->scene.photos[photo].test || state->removed[photo]))
        photo++;
    struct orl_view view = model->scene.photos[photo].view;
    struct orl_render_params render = state->render;
    render.leave_out = ~0u;
    view.camera = orl_camera_resized(&view.camera, SIDE, SIDE);
    enum orl_result result =
        orl_renderer_draw(model->renderer, &view, &render, state->removed, NULL);
    return result == ORL_OK ? orl_gpu_finish(source->gpu) : result;
}

enum orl_result orl_trim_model_open(const struct trim_source *source,
                                    const struct trim_state *state, struct trim_model **out)
{
    size_t points = 0, photos = 0, all = source->scene->points.count;
    size_t count = (size_t)(orl_trim_point_shares[state->points] * (double)all + 0.5);
    struct trim_model *model = orl_array(source->log, 1, sizeof *model);
    *out = model;
    if (!model)
        return ORL_ERR_MEMORY;
    model->scene = *source->scene;
    model->scene.photos = NULL;
    model->scene.defaults = orl_trim_defaults(source, state);
    enum orl_result result = set_photos(source, state, model);
    if (result == ORL_OK && count < all) {
        result = orl_points_thin_out(source->log, &source->scene->points, source->ranking.order,
                                     count, &model->points);
        model->scene.points = model->points;
    }
    orl_trim_count_bytes(source->gpu, &points, &photos);
    if (result == ORL_OK)
        result = orl_renderer_create(source->gpu, &model->scene, NULL, &model->renderer);
    if (result == ORL_OK)
        result = draw_first_frame(source, state, model);
    orl_trim_count_bytes(source->gpu, &model->point_bytes, &model->photo_bytes);
    model->point_bytes -= points;
    model->photo_bytes -= photos;
    if (result != ORL_OK)
        orl_trim_model_close(out);
    return result;
}

void orl_trim_model_close(struct trim_model **handle)
{
    struct trim_model *model = *handle;
    if (!model)
        return;
    orl_renderer_destroy(&model->renderer);
    orl_points_finish(&model->points);
    free(model->scene.photos);
    free(model->dir);
    free(model);
    *handle = NULL;
}
