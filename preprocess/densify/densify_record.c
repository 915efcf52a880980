// stereo/densify.json: the inputs and settings of the maps beside it, so that a run with others
// makes the maps again.
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>
#include <xxhash.h>

#include "core/json.h"
#include "preprocess/densify/densify_internal.h"

static const char *const map_dirs[] = {"stereo/depth_maps", "stereo/normal_maps",
                                       "stereo/confidence_maps"};

struct digest {
    const struct orl_log *log;
    XXH3_state_t *state;
};

static void add_text(struct digest *digest, const char *text)
{
    XXH3_64bits_update(digest->state, text, strlen(text) + 1);
}

// Adds a file's name and contents. A missing file has checksum 0.
static enum orl_result add_file(struct digest *digest, const char *dir, const char *name,
                                const char *suffix)
{
    uint64_t hash = 0;
    const char *path = ORL_PATH(dir, "%s%s", name, suffix);
    enum orl_result result = orl_path_is_file(path) ? orl_file_hash(digest->log, path, &hash) : ORL_OK;
    add_text(digest, name);
    XXH3_64bits_update(digest->state, &hash, sizeof hash);
    return result;
}

static enum orl_result add_model(struct digest *digest, const char *workspace)
{
    static const char *const names[] = {"cameras", "images", "points3D"};
    const char *dir = ORL_PATH(workspace, "sparse");
    for (size_t i = 0; i < ORL_COUNT(names); i++) {
        ORL_TRY(add_file(digest, dir, names[i], ".bin"));
        ORL_TRY(add_file(digest, dir, names[i], ".txt"));
    }
    return ORL_OK;
}

static enum orl_result add_pictures(struct digest *digest, const char *workspace,
                                    const struct densify_photos *photos, const char *masks_dir)
{
    const char *dir = ORL_PATH(workspace, "images");
    for (size_t i = 0; i < photos->count; i++) {
        ORL_TRY(add_file(digest, dir, densify_photo_name(photos, i), ""));
        if (masks_dir)
            ORL_TRY(add_file(digest, masks_dir, densify_photo_name(photos, i), ".png"));
    }
    return ORL_OK;
}

static json_t *make_settings(const struct orl_densify_params *params, int shrink)
{
    return json_pack("{s:i, s:i, s:i, s:i, s:i, s:I, s:i, s:b}", "sources", params->sources,
                     "iterations", params->iterations, "geometric_passes",
                     params->geometric_passes, "window_radius", params->window_radius,
                     "window_step", params->window_step, "seed", (json_int_t)params->seed,
                     "halvings", shrink, "masks", params->masks_dir != NULL);
}

static enum orl_result make_record(const struct orl_log *log, const char *workspace,
                                   const struct densify_photos *photos,
                                   const struct orl_densify_params *params, int shrink,
                                   json_t **record)
{
    struct digest digest = {log, XXH3_createState()};
    if (!digest.state)
        return orl_fail(log, ORL_ERR_MEMORY, "no memory for a checksum");
    XXH3_64bits_reset(digest.state);
    enum orl_result result = add_model(&digest, workspace);
    ORL_THEN(result, add_pictures(&digest, workspace, photos, params->masks_dir));
    if (result == ORL_OK)
        *record = json_pack(
            "{s:i, s:o, s:o}", "version", ORL_DENSIFY_VERSION, "settings",
            make_settings(params, shrink), "inputs",
            json_sprintf("xxh3:%016" PRIx64, XXH3_64bits_digest(digest.state)));
    if (result == ORL_OK && !*record)
        result = orl_fail(log, ORL_ERR_MEMORY, "no memory for the stereo's record");
    XXH3_freeState(digest.state);
    return result;
}

// True when a photograph has a map of any kind, one that takes no part in this run, too: a later run with other
// settings removes the folders as a whole.
static bool has_maps(const char *workspace, const struct orl_colmap_model *model)
{
    static const char *const kinds[] = {"photometric", "geometric"};
    for (size_t i = 0; i < model->image_count; i++)
        for (size_t k = 0; k < ORL_COUNT(kinds) * ORL_COUNT(map_dirs); k++)
            if (orl_path_is_file(ORL_PATH(workspace, "%s/%s.%s.bin", map_dirs[k / 2], model->images[i].name,
                                          kinds[k % 2])))
                return true;
    return false;
}

static enum orl_result remove_maps(const struct orl_log *log, const char *workspace)
{
    for (size_t i = 0; i < ORL_COUNT(map_dirs); i++)
        ORL_TRY(orl_dir_remove(log, ORL_PATH(workspace, "%s", map_dirs[i])));
    return ORL_OK;
}

// Maps must be removed and written only below the workspace, so links are refused.
static enum orl_result refuse_links(const struct orl_log *log, const char *workspace)
{
    for (size_t i = 0; i <= ORL_COUNT(map_dirs); i++) {
        struct stat st;
        const char *path = ORL_PATH(workspace, "%s", i ? map_dirs[i - 1] : "stereo");
        if (lstat(path, &st) == 0 && !S_ISDIR(st.st_mode))
            return orl_fail(log, ORL_ERR_ARGUMENT, "%s: a link or file in place of the folder of "
                            "maps, which is not followed; remove it", path);
    }
    return ORL_OK;
}

enum orl_result orl_densify_claim_maps(const struct orl_log *log, const char *workspace,
                                       const struct densify_photos *photos,
                                       const struct orl_densify_params *params, int shrink)
{
    json_t *record = NULL, *old = NULL;
    const char *stereo = ORL_PATH(workspace, "stereo"), *path = ORL_PATH(workspace, "stereo/densify.json");
    ORL_TRY(refuse_links(log, workspace));
    ORL_TRY(make_record(log, workspace, photos, params, shrink, &record));
    bool any = has_maps(workspace, photos->model), ours = orl_path_is_file(path);
    enum orl_result result = ORL_OK;
    if (any && !ours) {
        result = orl_fail(log, ORL_ERR_ARGUMENT,
                          "%s/depth_maps: these maps were not made by oriel densify, or by one "
                          "that kept no record of how; remove them to have them made", stereo);
        goto end;
    }
    // An unreadable record counts as a record of other settings.
    bool same = ours && orl_json_read(NULL, path, &old) == ORL_OK && json_equal(old, record);
    if (same)
        goto end;
    if (any)
        orl_logf(log, ORL_LOG_WARNING,
                 "densify: the maps there are of other photographs or settings: made again");
    // The maps go first: after an interruption the old record still describes the remaining maps.
    if (ours)
        result = remove_maps(log, workspace);
    ORL_THEN(result, orl_dir_make(log, stereo));
    ORL_THEN(result, orl_json_write(log, path, record));
end:
    json_decref(record);
    json_decref(old);
    return result;
}

enum orl_result orl_densify_check_maps(const struct orl_log *log, const char *workspace,
                                       const struct orl_densify_params *params, int shrink)
{
    json_t *record = NULL, *settings = make_settings(params, shrink);
    const char *path = ORL_PATH(workspace, "stereo/densify.json");
    enum orl_result result = settings ? refuse_links(log, workspace) : ORL_ERR_MEMORY;
    bool same = result == ORL_OK && orl_path_is_file(path) &&
                orl_json_read(NULL, path, &record) == ORL_OK &&
                json_integer_value(json_object_get(record, "version")) == ORL_DENSIFY_VERSION &&
                json_equal(json_object_get(record, "settings"), settings);
    if (result == ORL_OK && !same)
        result = orl_fail(log, ORL_ERR_ARGUMENT, "%s: not begun with these settings; run oriel "
                          "prepare --until undistort first, and oriel plan for the commands",
                          path);
    json_decref(record);
    json_decref(settings);
    return result;
}
