#include "walk/content_internal.h"

#include <stdlib.h>
#include <string.h>

#include <libwebsockets.h>

#include "bridge/bridge.h"
#include "io/picture.h"
#include "core/memory.h"
#include "render/photos/photo_loader.h"
#include "walk/choices.h"
#include "walk/internal.h"
#include "walk/publish.h"

enum { MAP_POINTS = 16000 };
static const char site_folder[] = "/site/"; // where clients find the published site's data
enum { PICTURE_SIDE = 1600, PICTURE_QUALITY = 88, THUMB_SIDE = 160, THUMB_QUALITY = 70 };

// --- manifest, page and scene ---

static json_t *photo_json(const struct orl_photo *photo, size_t number)
{
    json_t *json = orl_walk_photo(photo, &photo->view.camera);
    json_object_set_new(json, "held_out", json_boolean(photo->test));
    json_object_set_new(json, "picture", json_pack("{s:o}", "file", json_sprintf("photos/%05zu.jpg", number)));
    json_object_set_new(json, "thumb", json_pack("{s:o}", "file", json_sprintf("thumbs/%05zu.jpg", number)));
    return json;
}

static json_t *tones_json(void)
{
    json_t *tones = json_array();
    for (int i = 0; i < ORL_TONE_COUNT; i++)
        json_array_append_new(tones, json_pack("{s:s, s:s}", "name", orl_tones[i].name,
                                               "description", orl_tones[i].description));
    return tones;
}

// The texts that the settings change: page and manifest.
static enum orl_result make_texts(struct content *content)
{
    const struct orl_log *log = content->log;
    size_t start;
    ORL_TRY(orl_walk_start(log, content->scene, &start));
    char *title = orl_walk_title(log, content->scene, content->title, content->settings);
    char *index = title ? orl_walk_index(log, title, "") : NULL;
    json_t *root = orl_walk_manifest(content->scene, content->settings, title ? title : "", start);
    json_t *photos = json_array();
    for (size_t i = 0; i < content->photo_count; i++)
        json_array_append_new(photos, photo_json(&content->scene->photos[content->photos[i]], i));
    json_object_set_new(root, "photos", photos);
    json_object_set_new(root, "live", json_true());
    json_object_set_new(root, "follows", json_boolean(content->scene->time_steps_dir != NULL));
    json_object_set_new(root, "edits", json_boolean(content->edits));
    json_object_set_new(root, "tones", tones_json());
    if (content->edits)
        json_object_set_new(root, "methods", orl_walk_methods_json(content->choice));
    char *manifest = json_dumps(root, JSON_INDENT(1));
    json_decref(root);
    free(title);
    if (!index || !manifest) {
        free(index);
        free(manifest);
        return ORL_ERR_MEMORY;
    }
    free(content->index);
    free(content->manifest);
    content->index = index;
    content->manifest = manifest;
    return ORL_OK;
}

enum orl_result orl_content_init(const struct orl_log *log, const struct orl_scene *scene,
                                 const char *title, bool edits, const struct orl_choice *choice,
                                 struct content *content)
{
    *content = (struct content){.log = log, .scene = scene, .title = title, .edits = edits,
                                .choice = choice};
    content->photos = orl_array(log, scene->photo_count, sizeof *content->photos);
    enum orl_result result = content->photos ? ORL_OK : ORL_ERR_MEMORY;
    // Held-out photographs come last, so that the others have the numbers of the published site.
    for (int test = 0; test < 2; test++)
        for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
            if (scene->photos[i].test == (test == 1))
                content->photos[content->photo_count++] = i;
    ORL_THEN(result, orl_walk_settings_read(log, scene, &content->settings));
    ORL_THEN(result, make_texts(content));
    if (result != ORL_OK)
        orl_content_finish(content);
    return result;
}

enum orl_result orl_content_change(struct content *content, json_t *settings)
{
    ORL_TRY(orl_walk_settings_check(content->log, "a client's settings", settings));
    ORL_TRY(orl_walk_settings_write(content->log, content->scene, settings));
    json_decref(content->settings);
    content->settings = json_incref(settings);
    return make_texts(content);
}

// --- the published site ---

static void forget_site(struct content *content)
{
    for (size_t i = 0; content->site && i < content->site_paths.count; i++)
        free(content->site[i].data);
    free(content->site);
    content->site = NULL;
    orl_names_finish(&content->site_paths);
}

static enum orl_result read_site(struct content *content, const char *dir)
{
    static const size_t file_max = (size_t)1 << 30;
    const struct orl_names *paths = &content->site_paths;
    ORL_TRY(orl_site_files(content->log, dir, true, &content->site_paths));
    content->site = orl_array(content->log, paths->count, sizeof *content->site);
    ORL_TRY_MEMORY(content->site);
    for (size_t i = 0; i < paths->count; i++)
        ORL_TRY(orl_file_read(content->log, ORL_PATH(dir, "%s", paths->items[i]), file_max, &content->site[i].data,
                              &content->site[i].size));
    return ORL_OK;
}

enum orl_result orl_content_publish(struct content *content, struct orl_gpu *gpu, struct orl_scene *scene, bool radiance,
                                    const struct orl_progress *progress)
{
    const struct orl_log *log = content->log;
    struct orl_publish_report report;
    char *dir = NULL;
    ORL_TRY(orl_dir_make_temporary(log, "walk", &dir));
    const char *site = ORL_PATH(dir, "site");
    struct orl_publish_params params = {ORL_PUBLISH_DEFAULTS};
    params.out = site;
    params.radiance = radiance;
    params.progress = progress;
    enum orl_result result = orl_publish(gpu, scene, &params, &report);
    ORL_THEN(result, read_site(content, site));
    if (orl_dir_remove(log, dir) != ORL_OK && result == ORL_OK)
        result = ORL_ERR_IO;
    if (result != ORL_OK)
        forget_site(content);
    free(dir);
    return result;
}

void orl_content_finish(struct content *content)
{
    free(content->index);
    free(content->manifest);
    free(content->photos);
    json_decref(content->settings);
    forget_site(content);
    *content = (struct content){0};
}

// --- files ---

static enum orl_result copy(const struct content *content, const char *type, const void *data, size_t size,
                            struct content_file *file)
{
    *file = (struct content_file){.type = type, .data = orl_array(content->log, size, 1), .size = size};
    ORL_TRY_MEMORY(file->data);
    memcpy(file->data, data, size);
    return ORL_OK;
}

static enum orl_result make_picture(const struct content *content, size_t number, int side,
                                    int quality, struct content_file *file)
{
    const struct orl_log *log = content->log;
    struct orl_image image = {0}, small = {0};
    enum orl_result result =
        orl_photo_read(log, content->scene, content->photos[number], false, &image);
    int longer = image.width > image.height ? image.width : image.height;
    bool shrinks = result == ORL_OK && longer > side;
    if (shrinks)
        result = orl_bridge_resize(log, &image, (image.width * side + longer - 1) / longer,
                                   (image.height * side + longer - 1) / longer, &small);
    ORL_THEN(result, orl_jpeg_encode(log, shrinks ? &small : &image, quality, &file->data, &file->size));
    file->type = "image/jpeg";
    orl_image_finish(&image);
    orl_image_finish(&small);
    return result;
}

// Points for the map: x y z as floats, then colour in four bytes; evenly chosen.
static enum orl_result make_map(const struct content *content, struct content_file *file)
{
    struct map_point {
        float position[3];
        uint8_t color[4];
    };
    _Static_assert(sizeof(struct map_point) == 16, "as web/js/live.js reads it");
    const struct orl_points *points = &content->scene->points;
    size_t step = points->count / MAP_POINTS + 1, count = points->count / step;
    struct map_point *map = orl_array(content->log, count ? count : 1, sizeof *map);
    for (size_t i = 0; map && i < count; i++) {
        memcpy(map[i].position, points->position[i * step], sizeof map[i].position);
        memcpy(map[i].color, points->color[i * step], sizeof points->color[0]);
    }
    *file = (struct content_file){"application/octet-stream", (uint8_t *)map, count * sizeof *map};
    return map ? ORL_OK : ORL_ERR_MEMORY;
}

// Reads the number in a photograph's path "FOLDER/NNNNN.jpg". Returns false for other paths.
static bool photo_number(const struct content *content, const char *path, const char *folder,
                         size_t *number)
{
    size_t length = strlen(folder);
    if (strncmp(path, folder, length) != 0 || strlen(path) != length + 9 ||
        strspn(path + length, "0123456789") != 5 || strcmp(path + length + 5, ".jpg") != 0)
        return false;
    *number = (size_t)atoi(path + length);
    return *number < content->photo_count;
}

static const char *type_of(const char *path)
{
    const char *type = lws_get_mimetype(path, NULL);
    return type ? type : "application/octet-stream";
}

static enum orl_result find_in_site(const struct content *content, const char *path,
                                    struct content_file *file)
{
    for (size_t i = 0; i < content->site_paths.count; i++)
        if (strcmp(content->site_paths.items[i], path) == 0)
            return copy(content, type_of(path), content->site[i].data, content->site[i].size, file);
    return ORL_ERR_NOT_FOUND;
}

static bool is_index(const char *path)
{
    return strcmp(path, "/") == 0 || strcmp(path, "/index.html") == 0;
}

bool orl_content_is_page(const char *path)
{
    return is_index(path) || orl_walk_page_file(path + 1);
}

enum orl_result orl_content_find(const struct content *content, const char *path,
                             struct content_file *file)
{
    size_t number;
    *file = (struct content_file){0};
    if (is_index(path))
        return copy(content, "text/html", content->index, strlen(content->index), file);
    if (strcmp(path, "/manifest.json") == 0)
        return copy(content, "application/json", content->manifest, strlen(content->manifest), file);
    if (strncmp(path, site_folder, strlen(site_folder)) == 0)
        return find_in_site(content, path + strlen(site_folder), file);
    if (strcmp(path, "/map.bin") == 0)
        return make_map(content, file);
    if (photo_number(content, path, "/thumbs/", &number))
        return make_picture(content, number, THUMB_SIDE, THUMB_QUALITY, file);
    if (photo_number(content, path, "/photos/", &number))
        return make_picture(content, number, PICTURE_SIDE, PICTURE_QUALITY, file);
    const char *text = orl_walk_page_file(path + 1);
    return text ? copy(content, type_of(path), text, strlen(text), file) : ORL_ERR_NOT_FOUND;
}
