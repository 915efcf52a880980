// Measured rows below OUT/rows, one file each.
#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "core/json.h"
#include "core/memory.h"
#include "eval/chart_internal.h"
#include "eval/commit.h"

void orl_chart_id(const char *method, const char *setting, char id[128])
{
    snprintf(id, 128, "%s%s%s", method, setting[0] ? "." : "", setting);
    for (char *c = id; *c; c++)
        if (!isalnum((unsigned char)*c) && *c != '.' && *c != '_')
            *c = '-';
}

json_t *orl_chart_provenance(const struct chart_scene *scene)
{
    const struct orl_gpu_caps *caps = orl_gpu_caps(scene->gpu);
    return json_pack("{s:s, s:s, s:s, s:s, s:b, s:I, s:f, s:I}", "commit", orl_commit(), "device",
                     caps->renderer, "driver", caps->version, "scene_checksum", scene->checksum,
                     "quick", scene->params->quick, "views", (json_int_t)scene->view_count,
                     "seconds", scene->params->seconds, "max_vram_bytes",
                     (json_int_t)scene->params->max_vram_bytes);
}

static char *row_path(const struct chart_scene *scene, const char *id)
{
    return orl_format(orl_gpu_log(scene->gpu), "%s/rows/%s/%s.json", scene->params->out,
                      scene->name, id);
}

static bool has_pictures(const struct chart_scene *scene, const json_t *row)
{
    const json_t *views = json_object_get(row, "views");
    static const char *const keys[] = {"picture", "error_map"};
    bool there = json_array_size(views) == scene->view_count;
    for (size_t i = 0; there && i < json_array_size(views); i++)
        for (size_t k = 0; there && k < ORL_COUNT(keys); k++) {
            const char *name = json_string_value(json_object_get(json_array_get(views, i),
                                                                 keys[k]));
            char *path = name ? orl_path_join(NULL, scene->params->out, name) : NULL;
            there = path && orl_path_is_file(path);
            free(path);
        }
    return there;
}

json_t *orl_chart_load_row(const struct chart_scene *scene, const char *id)
{
    json_t *row = NULL, *wanted = orl_chart_provenance(scene);
    char *path = row_path(scene, id);
    bool known = path && orl_commit()[0] && orl_path_is_file(path) &&
                 orl_json_read(NULL, path, &row) == ORL_OK;
    if (!known || !json_equal(json_object_get(row, "provenance"), wanted) ||
        !has_pictures(scene, row)) {
        json_decref(row);
        row = NULL;
    }
    json_decref(wanted);
    free(path);
    return row;
}

enum orl_result orl_chart_keep_row(const struct chart_scene *scene, const char *id,
                                   const json_t *row)
{
    const struct orl_log *log = orl_gpu_log(scene->gpu);
    char *dir = orl_format(log, "%s/rows/%s", scene->params->out, scene->name);
    char *path = row_path(scene, id);
    enum orl_result result = dir && path ? orl_dir_make(log, dir) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_json_write(log, path, row);
    free(dir);
    free(path);
    return result;
}

// --- the scene's checksum ---

// Adds a file to the checksum, if it exists.
static enum orl_result add_file(const struct orl_log *log, XXH3_state_t *state, const char *dir,
                                const char *name)
{
    uint64_t hash;
    char *path = orl_path_join(log, dir, name);
    enum orl_result result = path ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK && orl_path_is_file(path)) {
        result = orl_file_hash(log, path, &hash);
        XXH3_64bits_update(state, name, strlen(name));
        XXH3_64bits_update(state, &hash, sizeof hash);
    }
    free(path);
    return result;
}

enum orl_result orl_chart_checksum(const struct orl_log *log, const struct orl_scene *scene,
                                   char text[32])
{
    static const char *const files[] = {
        "scene.json", "points.ply", "fused.ply", "sparse/cameras.bin", "sparse/images.bin",
        "sparse/cameras.txt", "sparse/images.txt"};
    XXH3_state_t *state = XXH3_createState();
    if (!state)
        return orl_fail(log, ORL_ERR_MEMORY, "no memory for a checksum");
    XXH3_64bits_reset(state);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(files); i++)
        result = add_file(log, state, scene->dir, files[i]);
    char *images = orl_path_join(log, scene->dir, "images");
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        result = images ? add_file(log, state, images, scene->photos[i].name) : ORL_ERR_MEMORY;
    snprintf(text, 32, "%016" PRIx64, (uint64_t)XXH3_64bits_digest(state));
    XXH3_freeState(state);
    free(images);
    return result;
}
