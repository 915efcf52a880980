// Writes a trimmed scene: an ordinary scene folder, whose scene.json is written last.
#include <stdlib.h>
#include <sys/stat.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "eval/trim_search.h"
#include "scene/subset.h"
#include "scene/tuned_settings.h"

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

// Lists the photographs that trimming removed under "left_out".
static void list_left_out(const struct orl_subset *subset)
{
    const struct orl_scene *scene = subset->scene;
    json_t *left = json_object_get(subset->manifest, "left_out");
    if (!json_is_array(left)) {
        left = json_array();
        json_object_set_new(subset->manifest, "left_out", left);
    }
    for (size_t i = 0; i < scene->photo_count; i++)
        if (!subset->keep[i])
            json_array_append_new(left, json_pack("{s:s, s:s}", "name", scene->photos[i].name,
                                                  "why", "trimmed"));
}

static enum orl_result write_manifest(const struct orl_subset *subset, const struct orl_choice *choice)
{
    const struct orl_scene *scene = subset->scene;
    json_t *root = subset->manifest, *tuned = json_object_get(root, "tuned");
    json_t *render = orl_defaults_json(&scene->defaults);
    const char *path = ORL_PATH(subset->dir, "scene.json"), *method = choice->method->name;
    json_object_set_new(render, "method", json_string(method));
    if (!json_is_object(tuned)) {
        tuned = json_object();
        json_object_set_new(root, "tuned", tuned);
    }
    json_object_set_new(tuned, method, json_pack("{s:o}", "settings", orl_choice_settings(choice)));
    list_left_out(subset);
    json_object_set_new(json_object_get(root, "counts"), "points", json_integer((json_int_t)scene->points.count));
    json_object_set_new(root, "trimmed_from", orl_json_string(scene->dir));
    return json_object_set_new(root, "render", render) == 0
               ? orl_json_write(subset->log, path, root)
               : orl_fail(subset->log, ORL_ERR_MEMORY, "%s: no memory for it", path);
}

enum orl_result orl_trim_write_scene(const struct orl_log *log, const struct orl_scene *scene,
                                     const bool *removed, const struct orl_choice *choice,
                                     const char *out)
{
    bool *keep = orl_array(log, scene->photo_count, sizeof *keep);
    struct orl_subset subset = {.log = log, .scene = scene, .keep = keep, .points = &scene->points, .dir = out};
    for (size_t i = 0; keep && i < scene->photo_count; i++)
        keep[i] = !removed[i];
    enum orl_result result = keep ? orl_dir_make(log, out) : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_subset_begin(&subset));
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (keep[i])
            result = orl_subset_copy_photo(&subset, i);
    ORL_THEN(result, write_manifest(&subset, choice));
    json_decref(subset.manifest);
    free(keep);
    return result;
}
