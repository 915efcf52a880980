#include "preprocess/scene_json.h"

#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/arguments.h"
#include "preprocess/stages.h"
#include "scene/manifest.h"

static json_t *stage_value(const json_t *done, const char *stage, const char *key)
{
    return json_object_get(json_object_get(done, stage), key);
}

static json_t *settings(const struct orl_prepare_params *p)
{
    json_t *settings = json_pack("{s:i, s:b}", "max_size", orl_prepare_max_size(p), "masks",
                                 p->masks_dir != NULL);
    orl_arguments_settings(settings, orl_prepare_options(), p, "scene");
    return settings;
}

// Adds a stage's record without the parts that scene.json has elsewhere.
static void copy_stage(const json_t *done, const char *name, json_t *stages)
{
    static const char *const elsewhere[] = {"photographs", "responses", "left_out",
                                             "skipped", "ground", "backdrop",
                                             "occluded", "tuned", "render", "files", "sum"};
    json_t *record = name ? json_deep_copy(json_object_get(done, name)) : NULL;
    for (size_t i = 0; record && i < ORL_COUNT(elsewhere); i++)
        json_object_del(record, elsewhere[i]);
    if (record)
        json_object_set_new(stages, name, record);
}

// The stages' records in order.
static json_t *copy_stages(const json_t *plan, const json_t *done)
{
    json_t *stages = json_object();
    for (size_t k = 0; k < json_array_size(plan); k++)
        copy_stage(done, json_string_value(json_array_get(plan, k)), stages);
    copy_stage(done, ORL_REFINE_RECORD, stages);
    return stages;
}

// Checksums of all files of the scene, as the stages recorded them. Files below .oriel are not part
// of the scene.
static json_t *checksums(const json_t *plan, const json_t *done)
{
    json_t *sums = json_object(), *sum;
    const char *name;
    for (size_t k = 0; k < json_array_size(plan); k++) {
        const char *stage = json_string_value(json_array_get(plan, k));
        json_object_foreach(stage_value(done, stage, "files"), name, sum)
            if (strncmp(name, ".oriel/", 7) != 0)
                json_object_set(sums, name, sum);
    }
    return sums;
}

static int compare_photos(const void *a, const void *b)
{
    return strcmp(orl_json_text(*(json_t *const *)a, "name"),
                  orl_json_text(*(json_t *const *)b, "name"));
}

// Sorted by name, like every list of photographs.
static json_t *list_photos(const struct orl_job *job, const json_t *photos,
                           const json_t *occluded)
{
    size_t count = json_array_size(photos);
    json_t **items = calloc(count + 1, sizeof *items);
    json_t *sorted = json_array();
    for (size_t i = 0; items && i < count; i++)
        items[i] = json_array_get(photos, i);
    if (items)
        qsort(items, count, sizeof *items, compare_photos);
    for (size_t i = 0; items && i < count; i++) {
        const struct orl_source *source = orl_job_find(job, orl_json_text(items[i], "name"));
        json_t *entry = json_copy(items[i]);
        if (source && source->mask)
            json_object_set_new(entry, "mask", json_true());
        if (source && source->exif.orientation > 1)
            json_object_set_new(entry, "orientation", json_integer(source->exif.orientation));
        if (source && source->exif.placed)
            json_object_set_new(entry, "gps", json_pack("[f,f]", source->exif.latitude,
                                                        source->exif.longitude));
        json_t *share = json_object_get(occluded, orl_json_text(entry, "name"));
        if (share)
            json_object_set(entry, "occluded", share);
        json_array_append_new(sorted, entry);
    }
    free(items);
    return sorted;
}

static json_t *counts(const struct orl_job *job, const json_t *done, const json_t *photos)
{
    size_t test = 0;
    for (size_t i = 0; i < json_array_size(photos); i++) {
        const char *split = orl_json_text(json_array_get(photos, i), "split");
        test += split && strcmp(split, "test") == 0;
    }
    json_int_t registered = (json_int_t)json_array_size(photos);
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:O*, s:O*, s:O*}", "given",
                     (json_int_t)job->given, "skipped", (json_int_t)json_array_size(job->skipped),
                     "used", (json_int_t)job->source_count, "registered", registered, "train",
                     registered - (json_int_t)test, "test", (json_int_t)test, "left_out",
                     (json_int_t)job->source_count - registered, "sparse_points",
                     stage_value(done, "calibrate", "sparse_points"), "points",
                     stage_value(done, "radii", "points"), "triangles",
                     stage_value(done, "mesh", "triangles"));
}

static json_t *left_out(const struct orl_job *job, const json_t *done)
{
    json_t *list = json_deep_copy(job->skipped);
    const json_t *unplaced = stage_value(done, "calibrate", "left_out");
    for (size_t i = 0; i < json_array_size(unplaced); i++)
        json_array_append_new(list, json_pack("{s:O, s:s}", "name", json_array_get(unplaced, i),
                                              "why", "cannot be placed"));
    return list;
}

// Reads `root` as opening the scene would. Messages name `path`.
static enum orl_result try_manifest(struct orl_job *job, const struct orl_log *log,
                                    const char *path, const json_t *root)
{
    const struct orl_colmap_model *model;
    struct orl_scene *scene = NULL;
    enum orl_result result = orl_job_sparse(job, &model);
    ORL_THEN(result, orl_scene_open_model(job->log, job->dir, model, &scene));
    ORL_THEN(result, orl_manifest_take(log, path, root, scene));
    orl_scene_destroy(&scene);
    return result;
}

// Records of earlier versions have no checksum, so an edited value may come this far.
static enum orl_result check_manifest(struct orl_job *job, const json_t *root)
{
    const char *path = ORL_PATH(job->dir, ".oriel/stages.json");
    enum orl_result result = try_manifest(job, job->log, path, root);
    if (result == ORL_ERR_FORMAT)
        orl_logf(job->log, ORL_LOG_ERROR, "%s: makes no scene; remove this file and run prepare with "
                 "--resume, which does all stages again", path);
    return result;
}

// Keeps how the scene is drawn best, as tune and trim found it, while the scene is the same. What
// cannot be read holds nothing to keep.
static enum orl_result keep_tuned(struct orl_job *job, const char *path, json_t *root)
{
    json_t *old = NULL;
    if (!orl_path_is_file(path)) // removed before a stage ran again
        return ORL_OK;
    static const char *const kept[] = {"tuned", "render"};
    enum orl_result result = ORL_OK;
    if (orl_json_read(NULL, path, &old) != ORL_OK)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: cannot be read; written anew", path);
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(kept); i++) {
        json_t *value = json_object_get(old, kept[i]);
        if (value && json_object_set(root, kept[i], value) != 0)
            result = orl_fail(job->log, ORL_ERR_MEMORY, "%s: no memory for it", path);
        if (value && result == ORL_OK &&
            (result = try_manifest(job, NULL, path, root)) == ORL_ERR_FORMAT) {
            orl_logf(job->log, ORL_LOG_WARNING, "%s: \"%s\" cannot be read and is left out", path,
                     kept[i]);
            json_object_del(root, kept[i]);
            result = ORL_OK;
        }
    }
    json_decref(old);
    return result;
}

static json_t *make_manifest(const struct orl_job *job)
{
    const json_t *plan = json_object_get(job->stages, "plan");
    const json_t *done = json_object_get(job->stages, "done");
    json_t *tuned = stage_value(done, "tune", "tuned");
    json_t *photos = list_photos(job, stage_value(done, "expose", "photographs"),
                                 stage_value(done, "occluders", "occluded"));
    return json_pack("{s:s, s:i, s:s, s:o, s:o, s:o, s:O*, s:o, s:o, s:o, s:O, s:O*, s:O*}",
                     "format", "oriel scene", "version", ORL_MANIFEST_VERSION, "made_by",
                     "oriel " ORL_VERSION, "settings", settings(job->params), "counts",
                     counts(job, done, photos), "photographs", photos, "responses",
                     stage_value(done, "expose", "responses"), "left_out", left_out(job, done),
                     "stages", copy_stages(plan, done), "checksums", checksums(plan, done),
                     "ground", stage_value(done, "ground", "ground"), "backdrop",
                     stage_value(done, "tune", "backdrop"), "tuned",
                     json_object_size(tuned) ? tuned : NULL);
}

enum orl_result orl_scene_json_open(struct orl_job *job, struct orl_scene **scene)
{
    json_t *root = make_manifest(job);
    enum orl_result result = root ? orl_job_open_scene(job, scene)
                                  : orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the scene");
    ORL_THEN(result, orl_manifest_take(job->log, ORL_PATH(job->dir, ".oriel/stages.json"), root, *scene));
    if (result != ORL_OK)
        orl_scene_destroy(scene);
    json_decref(root);
    return result;
}

enum orl_result orl_scene_json_write(struct orl_job *job)
{
    const char *path = ORL_PATH(job->dir, "scene.json");
    json_t *root = make_manifest(job);
    enum orl_result result = root ? ORL_OK : orl_fail(job->log, ORL_ERR_MEMORY, "%s: no memory for it", path);
    ORL_THEN(result, check_manifest(job, root));
    ORL_THEN(result, keep_tuned(job, path, root));
    ORL_THEN(result, orl_json_write(job->log, path, root));
    json_decref(root);
    return result;
}
