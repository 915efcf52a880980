// Writes a trimmed scene: an ordinary scene folder, whose scene.json is written last.
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "eval/trim_search.h"
#include "scene/manifest.h"
#include "scene/subset.h"
#include "scene/tuned_settings.h"

struct writer {
    const struct orl_log *log;
    const struct orl_scene *scene; // with the points and the defaults to write
    const struct orl_choice *choice;
    const char *out;
    bool *keep;   // owned, per photograph
    json_t *sums; // owned: checksums of the files written
};

// --- files ---

static size_t file_size(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode) ? (size_t)status.st_size : 0;
}

size_t orl_trim_scene_file_bytes(const struct orl_scene *scene)
{
    static const char *const names[] = {"points.ply", "sparse/cameras.bin", "sparse/images.bin",
                                        "sparse/points3D.bin", "mesh.ply"};
    size_t bytes = 0;
    for (size_t i = 0; i < ORL_COUNT(names); i++)
        bytes += file_size(ORL_PATH(scene->dir, "%s", names[i]));
    for (size_t i = 0; i < scene->photo_count; i++)
        if (!scene->photos[i].test)
            bytes += file_size(orl_scene_file(scene, i, ORL_FILE_PHOTO).text) +
                     file_size(orl_scene_file(scene, i, ORL_FILE_MASK).text);
    return bytes;
}

// True for a file that belongs to a photograph that is left out. `path` begins with the folder of
// such files, as "masks", which for a time step of a sequence is in a folder as "frames/00012".
static bool is_left_out(const struct writer *w, const char *path)
{
    const struct orl_scene *scene = w->scene;
    int folders = strncmp(path, "frames/", 7) == 0 ? 3 : 1;
    for (; folders > 0 && path; folders--) {
        path = strchr(path, '/');
        path += path != NULL;
    }
    for (size_t i = 0; path && i < scene->photo_count; i++) {
        size_t length = strlen(scene->photos[i].name);
        if (!w->keep[i] && strncmp(path, scene->photos[i].name, length) == 0 &&
            (path[length] == '\0' || strcmp(path + length, ".png") == 0 ||
             strcmp(path + length, ".exr") == 0))
            return true;
    }
    return false;
}

static enum orl_result copy(const struct writer *w, const char *from, const char *name)
{
    ORL_TRY(orl_file_copy(w->log, from, ORL_PATH(w->out, "%s", name)));
    return orl_subset_add_checksum(w->log, w->out, name, w->sums);
}

// Copies SCENE/name, a file or a folder, without what belongs to photographs that are left out.
static enum orl_result copy_tree(const struct writer *w, const char *name)
{
    struct orl_names names = {0};
    char *from = orl_path_join(w->log, w->scene->dir, name);
    char *to = orl_path_join(w->log, w->out, name);
    enum orl_result result = from && to ? ORL_OK : ORL_ERR_MEMORY;
    bool folder = result == ORL_OK && orl_path_is_dir(from);
    if (result == ORL_OK && !folder && orl_path_is_file(from))
        result = copy(w, from, name);
    if (folder)
        result = orl_dir_make(w->log, to);
    if (folder && result == ORL_OK)
        result = orl_dir_list(w->log, from, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        char *inner = orl_path_join(w->log, name, names.items[i]);
        result = inner ? ORL_OK : ORL_ERR_MEMORY;
        if (inner && !is_left_out(w, inner))
            result = copy_tree(w, inner);
        free(inner);
    }
    orl_names_finish(&names);
    free(from);
    free(to);
    return result;
}

static enum orl_result write_photos(const struct writer *w)
{
    for (size_t i = 0; i < w->scene->photo_count; i++)
        if (w->keep[i])
            ORL_TRY(copy_tree(w, ORL_PATH("images", "%s", w->scene->photos[i].name)));
    return ORL_OK;
}

// --- scene.json ---

// The manifest of the whole scene. A workspace without one gets the least that a scene needs.
static enum orl_result read_manifest(const struct writer *w, json_t **root)
{
    const struct orl_scene *scene = w->scene;
    const char *path = ORL_PATH(scene->dir, "scene.json");
    if (orl_path_is_file(path))
        return orl_json_read(w->log, path, root);
    json_t *photos = json_array();
    for (size_t i = 0; i < scene->photo_count; i++)
        json_array_append_new(photos, json_pack("{s:s, s:s}", "name", scene->photos[i].name,
                                                "split", "train"));
    *root = json_pack("{s:s, s:i, s:s, s:o}", "format", "oriel scene", "version",
                      ORL_MANIFEST_VERSION, "made_by", "oriel " ORL_VERSION, "photographs",
                      photos);
    return *root ? ORL_OK : orl_fail(w->log, ORL_ERR_MEMORY, "no memory for the manifest");
}

// Lists the photographs that trimming removed under "left_out".
static void list_left_out(const struct writer *w, json_t *root)
{
    const struct orl_scene *scene = w->scene;
    json_t *left = json_object_get(root, "left_out");
    if (!json_is_array(left)) {
        left = json_array();
        json_object_set_new(root, "left_out", left);
    }
    for (size_t i = 0; i < scene->photo_count; i++)
        if (!w->keep[i])
            json_array_append_new(left, json_pack("{s:s, s:s}", "name", scene->photos[i].name,
                                                  "why", "trimmed"));
}

static enum orl_result write_manifest(const struct writer *w)
{
    json_t *root;
    ORL_TRY(read_manifest(w, &root));
    const char *path = ORL_PATH(w->out, "scene.json");
    const char *method = w->choice->method->name;
    json_t *render = orl_defaults_json(&w->scene->defaults), *tuned = json_object_get(root, "tuned");
    json_object_set_new(render, "method", json_string(method));
    if (!json_is_object(tuned)) {
        tuned = json_object();
        json_object_set_new(root, "tuned", tuned);
    }
    json_object_set_new(tuned, method,
                        json_pack("{s:o}", "settings", orl_choice_settings(w->choice)));
    list_left_out(w, root);
    orl_subset_keep_photographs(w->scene, w->keep, root);
    json_object_set_new(json_object_get(root, "counts"), "points",
                        json_integer((json_int_t)w->scene->points.count));
    json_object_set_new(root, "trimmed_from", orl_json_string(w->scene->dir));
    enum orl_result result =
        json_object_set_new(root, "render", render) == 0 && json_object_set(root, "checksums", w->sums) == 0
            ? orl_json_write(w->log, path, root)
            : orl_fail(w->log, ORL_ERR_MEMORY, "%s: no memory for it", path);
    json_decref(root);
    return result;
}

static enum orl_result write_parts(const struct writer *w)
{
    static const char *const trees[] = {"masks", "background", "occluders", "images_linear",
                                         "frames", "mesh.ply"};
    enum orl_result result = write_photos(w);
    ORL_THEN(result, orl_points_write(w->log, ORL_PATH(w->out, "points.ply"), &w->scene->points, true, NULL));
    ORL_THEN(result, orl_subset_write_model(w->log, w->scene, w->keep, w->out));
    ORL_THEN(result, orl_subset_add_checksums(w->log, w->out, w->sums));
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(trees); i++)
        result = copy_tree(w, trees[i]);
    return result == ORL_OK ? write_manifest(w) : result;
}

enum orl_result orl_trim_write_scene(const struct orl_log *log, const struct orl_scene *scene,
                                     const bool *removed, const struct orl_choice *choice,
                                     const char *out)
{
    struct writer w = {.log = log, .scene = scene, .choice = choice, .out = out, .sums = json_object(),
                       .keep = orl_array(log, scene->photo_count, sizeof *w.keep)};
    for (size_t i = 0; w.keep && i < scene->photo_count; i++)
        w.keep[i] = !removed[i];
    enum orl_result result = w.sums && w.keep ? orl_dir_make(log, out) : ORL_ERR_MEMORY;
    ORL_THEN(result, write_parts(&w));
    json_decref(w.sums);
    free(w.keep);
    return result;
}
