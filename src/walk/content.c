#include "walk/content_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "io/picture.h"
#include "core/memory.h"
#include "walk/internal.h"
#include "walk/web_table.h"

enum { PICTURE_SIDE = 1600, PICTURE_QUALITY = 88, THUMB_SIDE = 160, THUMB_QUALITY = 70 };

// --- manifest, page and scene ---

static json_t *photo_json(const struct orl_photo *photo, size_t number)
{
    char picture[64], thumb[64];
    snprintf(picture, sizeof picture, "photos/%05zu.jpg", number);
    snprintf(thumb, sizeof thumb, "thumbs/%05zu.jpg", number);
    json_t *json = orl_walk_photo(photo, &photo->view.camera);
    json_object_set_new(json, "picture", json_pack("{s:s}", "file", picture));
    json_object_set_new(json, "thumb", json_pack("{s:s}", "file", thumb));
    return json;
}

static enum orl_result make_manifest(struct content *content, const char *title)
{
    size_t start;
    enum orl_result result = orl_walk_start(content->log, content->scene, &start);
    if (result != ORL_OK)
        return result;
    json_t *root = orl_walk_manifest(content->scene, title, start), *photos = json_array();
    for (size_t i = 0; i < content->photo_count; i++)
        json_array_append_new(photos, photo_json(&content->scene->photos[content->photos[i]], i));
    json_object_set_new(root, "photos", photos);
    json_object_set_new(root, "live", json_true());
    content->manifest = json_dumps(root, JSON_INDENT(1));
    json_decref(root);
    return content->manifest ? ORL_OK : ORL_ERR_MEMORY;
}

enum orl_result orl_content_init(const struct orl_log *log, const struct orl_scene *scene,
                             const char *title, struct content *content)
{
    *content = (struct content){.log = log, .scene = scene};
    content->photos = orl_array(log, scene->photo_count, sizeof *content->photos);
    content->index = content->photos ? orl_walk_index(log, title, "") : NULL;
    enum orl_result result = content->index ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (!scene->photos[i].test)
            content->photos[content->photo_count++] = i;
    if (result == ORL_OK)
        result = make_manifest(content, title);
    if (result != ORL_OK)
        orl_content_finish(content);
    return result;
}

void orl_content_finish(struct content *content)
{
    free(content->index);
    free(content->manifest);
    free(content->photos);
    *content = (struct content){0};
}

// --- files ---

static struct content_file text_file(const char *type, const char *text)
{
    return (struct content_file){.type = type, .data = (const uint8_t *)text,
                                 .size = strlen(text)};
}

static enum orl_result make_picture(const struct content *content, size_t number, int side,
                                    int quality, struct content_file *file)
{
    const struct orl_log *log = content->log;
    struct orl_image image = {0}, small = {0};
    char *path = orl_scene_photo_path(log, content->scene, content->photos[number]);
    enum orl_result result = path ? orl_picture_read(log, path, 3, &image) : ORL_ERR_MEMORY;
    free(path);
    int longer = image.width > image.height ? image.width : image.height;
    bool shrinks = result == ORL_OK && longer > side;
    if (shrinks)
        result = orl_bridge_resize(log, &image, (image.width * side + longer - 1) / longer,
                                   (image.height * side + longer - 1) / longer, &small);
    if (result == ORL_OK)
        result = orl_jpeg_encode(log, shrinks ? &small : &image, quality, &file->owned,
                                 &file->size);
    file->type = "image/jpeg";
    file->data = file->owned;
    file->is_private = true;
    orl_image_finish(&image);
    orl_image_finish(&small);
    return result;
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
    const char *dot = strrchr(path, '.');
    return dot && strcmp(dot, ".js") == 0    ? "text/javascript"
           : dot && strcmp(dot, ".css") == 0 ? "text/css"
                                             : "text/plain";
}

enum orl_result orl_content_find(const struct content *content, const char *path,
                             struct content_file *file)
{
    size_t number;
    *file = (struct content_file){0};
    if (strcmp(path, "/") == 0 || strcmp(path, "/index.html") == 0) {
        *file = text_file("text/html", content->index);
        return ORL_OK;
    }
    if (strcmp(path, "/manifest.json") == 0) {
        *file = text_file("application/json", content->manifest);
        file->is_private = true;
        return ORL_OK;
    }
    if (photo_number(content, path, "/thumbs/", &number))
        return make_picture(content, number, THUMB_SIDE, THUMB_QUALITY, file);
    if (photo_number(content, path, "/photos/", &number))
        return make_picture(content, number, PICTURE_SIDE, PICTURE_QUALITY, file);
    for (const struct orl_web_file *f = orl_web_table; f->name; f++)
        if (strcmp(f->name, path + 1) == 0 && strcmp(f->name, "index.html") != 0) {
            *file = text_file(type_of(path), f->text);
            return ORL_OK;
        }
    return ORL_ERR_NOT_FOUND;
}
