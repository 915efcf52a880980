// The stages, what each one's result depends on, and the records of earlier runs
// (.oriel/stages.json).
#include "preprocess/stages.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <xxhash.h>

#include "core/json.h"
#include "core/arguments.h"
#include "core/process.h"
#include "preprocess/cloud/fuse.h"
#include "preprocess/densify/densify.h"
#include "preprocess/densify_stage.h"
#include "preprocess/photos/normalise.h"
#include "scene/manifest.h"
#include "scene/point_lod.h"

// --- what a stage's result depends on, besides the stages before it ---

// Of the photographs, or of the masks that they have.
static json_t *hashes(const struct orl_job *job, bool masks)
{
    json_t *hashes = json_object();
    for (size_t i = 0; i < job->source_count; i++) {
        const struct orl_source *source = &job->sources[i];
        if (source->mask || !masks)
            json_object_set_new(hashes, source->name,
                                json_sprintf("%016" PRIx64, masks ? source->mask_hash : source->hash));
    }
    return hashes;
}

static json_t *photo_hashes(const struct orl_job *job)
{
    return hashes(job, false);
}

static json_t *test_names(const struct orl_job *job)
{
    json_t *names = json_array();
    for (size_t i = 0; i < job->source_count; i++)
        if (job->sources[i].test)
            json_array_append_new(names, json_string(job->sources[i].name));
    return names;
}

static json_t *calibrate_settings(const struct orl_job *job)
{
    return json_pack("{s:o, s:o*}", "masks", hashes(job, true), "normalised",
                     orl_normalise_wanted(job) ? json_string(job->exposures_hash) : NULL);
}

static json_t *undistort_settings(const struct orl_job *job)
{
    return json_pack("{s:i}", "max_size", orl_prepare_max_size(job->params));
}

static json_t *test_settings(const struct orl_job *job)
{
    return json_pack("{s:o}", "test", test_names(job));
}

static json_t *expose_settings(const struct orl_job *job)
{
    return json_pack("{s:o, s:s}", "test", test_names(job), "exposures", job->exposures_hash);
}

static bool is_mesh_wanted(const struct orl_job *job)
{
    return job->params->mesh != ORL_MESH_NONE;
}

static bool are_occluders_wanted(const struct orl_job *job)
{
    return job->params->occluders != ORL_OCCLUDER_SEARCH_NONE;
}

// What is made of renderings afterwards depends on whether there are any.
static json_t *occluders_settings(const struct orl_job *job)
{
    return json_pack("{s:b}", "find", are_occluders_wanted(job));
}

// --- the stages ---

enum { RESULTS_MAX = 4 };

struct stage {
    const char *name;
    int version; // raised when the stage's result changes for the same settings
    enum orl_stage_id needs;
    json_t *(*settings)(const struct orl_job *job); // besides options that are settings (`of` of
                                                    // their rows) themselves; NULL: no others
    enum orl_result (*run)(struct orl_job *job, json_t *record);
    const char *results[RESULTS_MAX + 1]; // files and folders that it writes
    const char *tells; // part of the record that scene.json needs
    bool repeatable;   // a repeated run gives the same result, so that later stages stay valid
    bool (*wanted)(const struct orl_job *job); // NULL: always
    bool named;        // what it tells is a list, each item with a name
    const char *reads; // file of the stage that it needs that may be deleted once it is done; NULL: none
    // About what it writes: of each photograph (features and matches), and of each pixel (docs/how/scale.md).
    double photo_bytes, pixel_bytes;
    const char *begun; // has all of that where an interrupted run or other jobs made it; NULL: nothing
};

static const struct stage stages[ORL_STAGE_COUNT] = {
    [ORL_STAGE_COLLECT] = {"collect", 1, ORL_STAGE_COLLECT, photo_hashes, .repeatable = true},
    [ORL_STAGE_CALIBRATE] = {"calibrate", 2, ORL_STAGE_COLLECT, calibrate_settings,
                             orl_stage_calibrate, {".oriel/calibrate/model"}, "left_out", false,
                             .photo_bytes = 2 << 20},
    [ORL_STAGE_UNDISTORT] = {"undistort", 1, ORL_STAGE_CALIBRATE, undistort_settings,
                             orl_stage_undistort,
                             {"sparse", "images", "images_linear", "masks"}, "largest", true,
                             .pixel_bytes = 2},
    // Depth maps may be deleted once they are read, and COLMAP's differ from run to run.
    [ORL_STAGE_DENSIFY] = {"densify", ORL_DENSIFY_VERSION, ORL_STAGE_UNDISTORT, test_settings,
                           orl_stage_densify, {0}, "tool", false, .pixel_bytes = 52,
                           .begun = "stereo/depth_maps"},
    [ORL_STAGE_FUSE] = {"fuse", ORL_FUSE_VERSION, ORL_STAGE_DENSIFY,
                        orl_stage_fuse_settings, orl_stage_fuse, {".oriel/fused.ply"}, "points", true,
                        .reads = "stereo/.oriel-key", .pixel_bytes = 6},
    [ORL_STAGE_RADII] = {"radii", 4, ORL_STAGE_FUSE, orl_stage_radii_settings, orl_stage_radii,
                         {"points.ply", ORL_LOD_NAME}, "points", true, .pixel_bytes = 3},
    [ORL_STAGE_GROUND] = {"ground", 5, ORL_STAGE_RADII, NULL, orl_stage_ground, {0},
                          "ground", .repeatable = true},
    [ORL_STAGE_MESH] = {"mesh", 1, ORL_STAGE_RADII, test_settings, orl_stage_mesh, {"mesh.ply"},
                        "triangles", true, .wanted = is_mesh_wanted},
    [ORL_STAGE_EXPOSE] = {"expose", 4, ORL_STAGE_RADII, expose_settings, orl_stage_expose, {0},
                          "photographs", true, .named = true},
    [ORL_STAGE_TUNE] = {"tune", 2, ORL_STAGE_EXPOSE, NULL, orl_stage_tune, {0}, "tuned", .repeatable = true},
    [ORL_STAGE_OCCLUDERS] = {"occluders", 1, ORL_STAGE_TUNE, occluders_settings,
                             orl_stage_occluders, {"occluders"}, "occluded", true,
                             .wanted = are_occluders_wanted},
};

static bool is_wanted(const struct orl_job *job, int id)
{
    return !stages[id].wanted || stages[id].wanted(job);
}

enum { SUM_SIZE = sizeof ((struct orl_job *)0)->keys[0] };

// Of `digits` significant digits of numbers; 0: all.
static enum orl_result sum_json(const struct orl_job *job, const json_t *value, size_t digits,
                                char sum[SUM_SIZE])
{
    char *text = value ? json_dumps(value, JSON_COMPACT | JSON_SORT_KEYS |
                                               JSON_REAL_PRECISION(digits))
                       : NULL;
    if (!text)
        return orl_fail(job->log, ORL_ERR_MEMORY, "no memory for a checksum");
    snprintf(sum, SUM_SIZE, "%016" PRIx64, (uint64_t)XXH3_64bits(text, strlen(text)));
    free(text);
    return ORL_OK;
}

// The checksum of a stage's record without its own "sum", the same before and after the record was
// written to a file.
static enum orl_result sum_record(const struct orl_job *job, json_t *record, char sum[SUM_SIZE])
{
    json_t *rest = json_copy(record);
    if (rest)
        json_object_del(rest, "sum");
    enum orl_result result = sum_json(job, rest, ORL_JSON_DIGITS, sum);
    json_decref(rest);
    return result;
}

// --- checksums of the files that a stage wrote, by which a later run finds damaged and missing ones ---

static enum orl_result add_file(const struct orl_job *job, const char *path, json_t *files)
{
    char sum[ORL_CHECKSUM_SIZE];
    enum orl_result result = orl_flush(job->log, path); // COLMAP does not
    ORL_THEN(result, orl_file_checksum(job->log, path, sum));
    if (result == ORL_OK &&
        json_object_set_new(files, path + strlen(job->dir) + 1, json_string(sum)) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for a checksum");
    return result;
}

static enum orl_result add_folder(const struct orl_job *job, const char *dir, json_t *files)
{
    struct orl_names names;
    enum orl_result result = orl_dir_list(job->log, dir, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        const char *path = ORL_PATH(dir, "%s", names.items[i]);
        if (orl_progress_cancelled(job->progress))
            result = ORL_ERR_CANCELLED;
        else if (orl_path_is_file(path))
            result = add_file(job, path, files);
    }
    orl_names_finish(&names);
    return result;
}

// Adds {name in the scene: checksum} to `files`, for each file of `names` and for all files in its
// folders. NULL ends `names`. Missing files are left out.
static enum orl_result sum_results(const struct orl_job *job, const char *const *names, json_t *files)
{
    for (; *names; names++) {
        const char *path = ORL_PATH(job->dir, "%s", *names);
        if (orl_path_is_dir(path))
            ORL_TRY(add_folder(job, path, files));
        else if (orl_path_is_file(path))
            ORL_TRY(add_file(job, path, files));
    }
    return ORL_OK;
}

// Compares each file with its checksum. Returns the first that differs or is missing, *why being the
// reason; NULL: none.
static const char *check_results(const struct orl_job *job, const json_t *files, const char **why)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)files, name, value) {
        char sum[ORL_CHECKSUM_SIZE];
        const char *told = json_string_value(value), *path = ORL_PATH(job->dir, "%s", name);
        bool read = orl_path_is_file(path) && orl_file_checksum(NULL, path, sum) == ORL_OK;
        if (read && told && strcmp(sum, told) == 0)
            continue;
        *why = read ? "changed since it was made" : "missing";
        return name;
    }
    return NULL;
}

// --- records ---

json_t *orl_stage_settings(const struct orl_job *job, enum orl_stage_id id)
{
    json_t *settings = stages[id].settings ? stages[id].settings(job) : json_object();
    orl_arguments_settings(settings, orl_prepare_options(), job->params, stages[id].name);
    return settings;
}

static enum orl_result set_keys(struct orl_job *job)
{
    for (int i = 0; i < ORL_STAGE_COUNT; i++) {
        json_t *inputs = json_pack("{s:s, s:i, s:s, s:o}", "stage", stages[i].name, "version",
                                   stages[i].version, "after", job->keys[stages[i].needs],
                                   "settings",
                                   orl_stage_settings(job, (enum orl_stage_id)i));
        enum orl_result result = sum_json(job, inputs, 0, job->keys[i]);
        json_decref(inputs);
        if (result != ORL_OK)
            return result;
    }
    return ORL_OK;
}

static json_t *done_stages(const struct orl_job *job)
{
    return json_object_get(job->stages, "done");
}

// An unreadable or foreign file counts as empty: all stages run again.
static json_t *read_stages(const struct orl_job *job, const char *path)
{
    json_t *root = NULL;
    if (orl_path_is_file(path) && (orl_json_read(NULL, path, &root) != ORL_OK ||
                                   !json_is_object(json_object_get(root, "done")))) {
        orl_logf(job->log, ORL_LOG_WARNING,
                 "%s: damaged, so nothing is known of the stages that were done", path);
        json_decref(root);
        root = NULL;
    }
    return root ? root
                : json_pack("{s:i, s:[], s:{}}", "version", ORL_MANIFEST_VERSION, "plan", "done");
}

enum orl_result orl_stages_load(struct orl_job *job)
{
    // The plan is always this program's, not that of the file.
    json_t *plan = json_array();
    for (int i = 0; i < ORL_STAGE_COUNT; i++)
        if (is_wanted(job, i))
            json_array_append_new(plan, json_string(stages[i].name));
    job->stages = read_stages(job, ORL_PATH(job->dir, ".oriel/stages.json"));
    bool set = json_object_set(job->stages, "plan", plan) == 0;
    json_decref(plan);
    return set ? ORL_OK : orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the stages");
}

static const char *old_key(const struct orl_job *job, int id)
{
    return orl_json_text(json_object_get(done_stages(job), stages[id].name), "key");
}

static bool has_same_key(const struct orl_job *job, int id)
{
    const char *key = old_key(job, id);
    return key && strcmp(key, job->keys[id]) == 0;
}

// Sets *sound when the record is as it was written and holds all that later steps need. An edited or
// damaged file may hold anything. Records of earlier versions have no checksum.
static enum orl_result check_record(const struct orl_job *job, json_t *record,
                                    enum orl_stage_id id, bool *sound)
{
    char sum[SUM_SIZE];
    const json_t *told_sum = json_object_get(record, "sum");
    *sound = false;
    ORL_TRY(sum_record(job, record, sum));
    if (told_sum && !(json_is_string(told_sum) && strcmp(json_string_value(told_sum), sum) == 0))
        return ORL_OK;
    const json_t *told = json_object_get(record, stages[id].tells);
    bool named = true;
    for (size_t i = 0; stages[id].named && i < json_array_size(told); i++)
        named = named && orl_json_text(json_array_get(told, i), "name");
    const json_t *files = json_object_get(record, "files");
    // No photograph may show occluders; then there are no files of them.
    bool nothing = json_is_object(told) && json_object_size(told) == 0;
    *sound = told && named && (!stages[id].results[0] || nothing || json_object_size(files) > 0);
    return ORL_OK;
}

// Sets *there when the stage was done with these inputs and settings and its result is unchanged.
static enum orl_result look_for(const struct orl_job *job, enum orl_stage_id id, bool *there)
{
    json_t *record = json_object_get(done_stages(job), stages[id].name);
    const char *why;
    // There is nothing to do for a stage that is not wanted, unless its result is to be removed.
    if (!is_wanted(job, id)) {
        *there = !old_key(job, id);
        return ORL_OK;
    }
    *there = false;
    if (!has_same_key(job, id))
        return ORL_OK;
    enum orl_result result = check_record(job, record, id, there);
    if (result == ORL_OK && !*there)
        orl_logf(job->log, ORL_LOG_WARNING, "%s/.oriel/stages.json: the record of %s was changed "
                 "or lacks a part; %s is done again", job->dir, stages[id].name, stages[id].name);
    if (!*there)
        return result;
    const char *damaged = check_results(job, json_object_get(record, "files"), &why);
    if (damaged)
        orl_logf(job->log, ORL_LOG_WARNING, "%s/%s: %s; %s is done again", job->dir, damaged, why,
                 stages[id].name);
    *there = !damaged;
    return ORL_OK;
}

static enum orl_result find_current(const struct orl_job *job, bool current[ORL_STAGE_COUNT])
{
    bool there[ORL_STAGE_COUNT] = {[ORL_STAGE_COLLECT] = true};
    // Settled: done, or made again with the same result.
    bool settled[ORL_STAGE_COUNT] = {[ORL_STAGE_COLLECT] = true};
    current[ORL_STAGE_COLLECT] = true;
    for (int i = 1; i < ORL_STAGE_COUNT; i++)
        ORL_TRY(look_for(job, (enum orl_stage_id)i, &there[i]));
    for (int i = 1; i < ORL_STAGE_COUNT; i++)
        if (stages[i].reads && (!there[i] || job->params->keep == ORL_KEEP_ALL) && !orl_job_has(job, stages[i].reads))
            there[stages[i].needs] = false;
    for (int i = 1; i < ORL_STAGE_COUNT; i++) {
        bool after = settled[stages[i].needs];
        current[i] = after && there[i];
        settled[i] = current[i] || (after && has_same_key(job, i) && stages[i].repeatable);
    }
    return ORL_OK;
}

// Before a stage changes any file, scene.json goes, which makes the folder a scene, and so do its soft splats and the
// records of the stage and of all later stages that depend on it.
static enum orl_result invalidate(const struct orl_job *job, const bool *current)
{
    bool all = true, changed = false;
    for (int i = 0; i < ORL_STAGE_COUNT; i++) {
        all = all && current[i];
        changed = changed || (old_key(job, i) && !has_same_key(job, i));
        if (!current[i])
            json_object_del(done_stages(job), stages[i].name);
    }
    if (all)
        return ORL_OK;
    enum orl_result result = orl_job_remove(job, "scene.json");
    ORL_THEN(result, orl_job_remove(job, ORL_SOFT_NAME)); // scene.json said how much of it pictures take
    json_object_del(done_stages(job), ORL_REFINE_RECORD);
    if (result == ORL_OK && changed)
        orl_logf(job->log, ORL_LOG_INFO,
                 "photographs or settings have changed: some stages are done again");
    return result == ORL_OK ? orl_job_save_stages(job) : result;
}

// From now on programs count for another stage.
static void reset_programs(struct orl_job *job)
{
    job->child_cpu_s = 0;
    json_decref(job->programs);
    job->programs = json_object();
    job->child_peak_bytes = 0;
}

// `start_s`, `start_cpu_s`: of the stage.
static void add_usage(const struct orl_job *job, double start_s, double start_cpu_s, json_t *record)
{
    struct rusage after;
    getrusage(RUSAGE_SELF, &after);
    json_object_set_new(record, "wall_s", json_real(orl_time_s() - start_s));
    json_object_set_new(record, "cpu_s", json_real(orl_cpu_time_s() - start_cpu_s + job->child_cpu_s));
    // ru_maxrss is Oriel's peak since its start; child processes are new.
    json_object_set_new(record, "peak_rss_mib", json_real((double)after.ru_maxrss / 1024));
    json_object_set_new(record, "child_peak_rss_mib",
                        json_real((double)job->child_peak_bytes / (1 << 20)));
    json_object_update(record, job->programs);
}

// Pixels of the undistorted photographs, held-out ones included.
static double scene_pixels(const struct orl_job *job)
{
    double pixels = 0, limit = orl_prepare_max_size(job->params);
    for (size_t i = 0; i < job->source_count; i++) {
        double w = job->sources[i].width, h = job->sources[i].height;
        double scale = limit / (w > h ? w : h);
        pixels += scale < 1 ? w * h * scale * scale : w * h;
    }
    return pixels;
}

static double disk_need(const struct orl_job *job, enum orl_stage_id id)
{
    if (stages[id].begun && orl_job_has(job, stages[id].begun))
        return 0;
    return stages[id].photo_bytes * (double)job->source_count + stages[id].pixel_bytes * scene_pixels(job);
}

static enum orl_result run_stage(struct orl_job *job, enum orl_stage_id id, json_t *record)
{
    json_t *files = json_object();
    double start = orl_time_s(), start_cpu = orl_cpu_time_s();
    reset_programs(job);
    json_object_set_new(record, "key", json_string(job->keys[id]));
    enum orl_result result = files ? orl_job_need_disk(job, stages[id].name, disk_need(job, id))
                                   : ORL_ERR_MEMORY;
    ORL_THEN(result, stages[id].run(job, record));
    if (result == ORL_ERR_IO)
        orl_job_hint_disk(job);
    ORL_THEN(result, sum_results(job, stages[id].results, files));
    if (json_object_size(files))
        json_object_set(record, "files", files);
    json_decref(files);
    add_usage(job, start, start_cpu, record);
    return result;
}

// A stage made from an outdated result is outdated too.
static void drop_dependents(const struct orl_job *job, enum orl_stage_id id, bool *current)
{
    bool depends[ORL_STAGE_COUNT] = {0};
    for (int i = (int)id + 1; i < ORL_STAGE_COUNT; i++) {
        depends[i] = stages[i].needs == id || depends[stages[i].needs];
        if (!depends[i])
            continue;
        current[i] = false;
        json_object_del(done_stages(job), stages[i].name);
    }
}

// Of a stage that is no longer wanted. Its record is gone already.
static enum orl_result remove_results(const struct orl_job *job, enum orl_stage_id id)
{
    for (size_t k = 0; stages[id].results[k]; k++)
        ORL_TRY(orl_job_remove(job, stages[id].results[k]));
    return ORL_OK;
}

// `before`: the records of earlier runs. The stage's new record and the removal of the records that
// it outdates are saved together.
static enum orl_result redo_stage(struct orl_job *job, enum orl_stage_id id, const json_t *before,
                                  bool *current)
{
    if (!is_wanted(job, id))
        return remove_results(job, id);
    json_t *record = json_object();
    char sum[SUM_SIZE];
    enum orl_result result = record ? run_stage(job, id, record) : ORL_ERR_MEMORY;
    ORL_THEN(result, sum_record(job, record, sum));
    if (result == ORL_OK && json_object_set_new(record, "sum", json_string(sum)) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for a checksum");
    if (result == ORL_OK) {
        const json_t *old = json_object_get(json_object_get(before, stages[id].name), "files");
        if (!old || !json_equal(old, json_object_get(record, "files")))
            drop_dependents(job, id, current);
        json_object_set(done_stages(job), stages[id].name, record);
        result = orl_job_save_stages(job);
    }
    json_decref(record);
    return result;
}

enum orl_result orl_stages_run(struct orl_job *job)
{
    bool current[ORL_STAGE_COUNT];
    json_t *before = json_deep_copy(done_stages(job));
    enum orl_result result = before ? find_current(job, current) : ORL_ERR_MEMORY;
    ORL_THEN(result, invalidate(job, current));
    static const int ends[] = {[ORL_UNTIL_END] = ORL_STAGE_COUNT,
                               [ORL_UNTIL_COLLECT] = ORL_STAGE_CALIBRATE,
                               [ORL_UNTIL_UNDISTORT] = ORL_STAGE_DENSIFY};
    int end = ends[job->params->until];
    for (int i = 1; result == ORL_OK && i < end; i++) {
        if (orl_progress_cancelled(job->progress))
            result = ORL_ERR_CANCELLED;
        else if (current[i] && is_wanted(job, i))
            orl_logf(job->log, ORL_LOG_INFO, "%s: done already", stages[i].name);
        else if (current[i])
            continue;
        else
            result = redo_stage(job, (enum orl_stage_id)i, before, current);
    }
    if (result == ORL_OK && end == ORL_STAGE_DENSIFY && !current[ORL_STAGE_DENSIFY])
        result = orl_stage_densify_begin(job);
    if (result == ORL_OK && end == ORL_STAGE_CALIBRATE && !current[ORL_STAGE_CALIBRATE])
        result = orl_calibrate_begin(job);
    json_decref(before);
    return result;
}

enum orl_result orl_stages_run_points(struct orl_job *job)
{
    bool current[ORL_STAGE_COUNT] = {0};
    for (int i = ORL_STAGE_DENSIFY; i < ORL_STAGE_COUNT; i++) {
        if (!is_wanted(job, i))
            continue;
        ORL_TRY(orl_progress_cancelled(job->progress)
                    ? ORL_ERR_CANCELLED
                    : redo_stage(job, (enum orl_stage_id)i, NULL, current));
    }
    return ORL_OK;
}

enum orl_result orl_stages_record_refine(struct orl_job *job, double start_s, double start_cpu_s)
{
    json_t *record = json_object();
    reset_programs(job);
    add_usage(job, start_s, start_cpu_s, record);
    if (json_object_set_new(done_stages(job), ORL_REFINE_RECORD, record) != 0)
        return orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the record of refine");
    return orl_job_save_stages(job);
}

// Texts that follow "oriel prepare" so that it does the same again in any folder.
static json_t *recorded_arguments(const struct orl_prepare_params *params)
{
    json_t *arguments = json_array();
    for (size_t i = 0; i < params->input_count; i++) {
        char *real = realpath(params->inputs[i], NULL);
        json_array_append_new(arguments, orl_json_string(real ? real : params->inputs[i]));
        free(real);
    }
    orl_arguments_record(arguments, orl_prepare_options(), params);
    return arguments;
}

enum orl_result orl_stages_begin(struct orl_job *job, double wall_s)
{
    ORL_TRY(set_keys(job));
    json_object_set_new(done_stages(job), "collect",
                        json_pack("{s:s, s:f, s:o, s:O}", "key", job->keys[ORL_STAGE_COLLECT],
                                  "wall_s", wall_s, "photographs", photo_hashes(job), "skipped",
                                  job->skipped));
    if (json_object_set_new(job->stages, "arguments", recorded_arguments(job->params)) != 0)
        return orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the arguments");
    return orl_job_save_stages(job);
}
