// Measured rows below OUT/rows, one file each, and what a row depends on.
#include "eval/row_store.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "eval/commit.h"
#include "scene/point_lod.h"

void orl_row_id(const char *method, const char *setting, char id[ORL_ROW_ID_MAX])
{
    snprintf(id, ORL_ROW_ID_MAX, "%s%s%s", method, setting[0] ? "." : "", setting);
    for (char *c = id; *c; c++)
        if (!isalnum((unsigned char)*c) && *c != '.' && *c != '_')
            *c = '-';
}

bool orl_row_part_has(const struct orl_part *part, size_t row)
{
    return !part->count || row % (size_t)part->count == (size_t)part->index;
}

const char *orl_row_text(const json_t *row, const char *key)
{
    const char *text = json_string_value(json_object_get(row, key));
    return text ? text : "";
}

double orl_row_number(const json_t *row, const char *key)
{
    const json_t *value = json_object_get(row, key);
    return json_is_number(value) ? json_number_value(value) : (double)NAN;
}

json_t *orl_number_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *orl_row_provenance(struct orl_gpu *gpu, const char *checksum)
{
    const struct orl_gpu_caps *caps = orl_gpu_caps(gpu);
    return json_pack("{s:s, s:s, s:s, s:s}", "commit", orl_commit(), "device", caps->renderer,
                     "driver", caps->version, "scene_checksum", checksum);
}

static char *row_path(const struct orl_row_store *store, const char *id)
{
    return orl_format(store->log, "%s/rows/%s/%s.json", store->out, store->group, id);
}

json_t *orl_row_load(const struct orl_row_store *store, const char *id, const json_t *provenance)
{
    json_t *row = NULL;
    char *path = row_path(store, id);
    bool known = path && orl_commit()[0] && orl_path_is_file(path) &&
                 orl_json_read(NULL, path, &row) == ORL_OK;
    if (!known || !json_equal(json_object_get(row, "provenance"), provenance)) {
        json_decref(row);
        row = NULL;
    }
    free(path);
    return row;
}

enum orl_result orl_row_keep(const struct orl_row_store *store, const char *id, json_t **row)
{
    json_t *kept = NULL;
    char *dir = orl_format(store->log, "%s/rows/%s", store->out, store->group);
    char *path = row_path(store, id);
    enum orl_result result = dir && path ? orl_dir_make(store->log, dir) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_json_write(store->log, path, *row);
    if (result == ORL_OK)
        result = orl_json_read(store->log, path, &kept);
    if (kept) {
        json_decref(*row);
        *row = kept;
    }
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

enum orl_result orl_row_checksum(const struct orl_log *log, const struct orl_scene *scene,
                                 char text[ORL_ROW_CHECKSUM_SIZE])
{
    static const char *const files[] = {
        "scene.json", "points.ply", ORL_LOD_NAME, "fused.ply", "sparse/cameras.bin",
        "sparse/images.bin", "sparse/cameras.txt", "sparse/images.txt"};
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
    snprintf(text, ORL_ROW_CHECKSUM_SIZE, "%016" PRIx64, (uint64_t)XXH3_64bits_digest(state));
    XXH3_freeState(state);
    free(images);
    return result;
}
