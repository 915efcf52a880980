#include "preprocess/calibrate/parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/lock.h"
#include "core/arguments.h"
#include "core/memory.h"
#include "preprocess/job/colmap_run.h"

#define WORK ORL_CALIBRATE_WORK
#define STATE ORL_PARTS_STATE
#define PAIRS WORK "/chosen.json"

const char *const orl_part_step_names[] = {ORL_PART_STEPS(ORL_ENUM_NAME) NULL};

// --- what the jobs need of the collected photographs ---

static json_t *photo_state(const struct orl_source *source, int group)
{
    return json_pack("{s:s, s:i, s:i, s:i, s:f, s:b, s:f, s:f}", "name", source->name, "camera", group,
                     "width", source->width, "height", source->height, "taken_s", source->exif.taken_s, "placed",
                     source->exif.placed, "latitude", source->exif.latitude, "longitude", source->exif.longitude);
}

bool orl_parts_begun(const struct orl_job *job)
{
    json_t *state = NULL;
    const char *path = ORL_PATH(job->dir, STATE);
    bool begun = orl_path_is_file(path) && orl_json_read(NULL, path, &state) == ORL_OK;
    const char *key = begun ? orl_json_text(state, "key") : NULL;
    begun = key && strcmp(key, job->keys[ORL_STAGE_CALIBRATE]) == 0;
    json_decref(state);
    return begun;
}

enum orl_result orl_parts_begin(struct orl_job *job, const struct orl_camera_groups *groups)
{
    const struct orl_prepare_params *p = job->params;
    json_t *photos = json_array();
    for (size_t i = 0; i < job->source_count; i++)
        json_array_append_new(photos, photo_state(&job->sources[i], groups->of[i]));
    json_t *state = json_pack("{s:s, s:b, s:o}", "key", job->keys[ORL_STAGE_CALIBRATE], "masks",
                              p->masks_dir != NULL, "photographs", photos);
    orl_arguments_settings(state, orl_prepare_options(), p, "parts");
    enum orl_result result = state ? orl_features_link_masks(job) : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_json_write(job->log, ORL_PATH(job->dir, STATE), state));
    json_decref(state);
    return result;
}

static enum orl_result read_photo(struct orl_job *job, json_t *state,
                                  struct orl_camera_groups *groups)
{
    const char *name = NULL;
    size_t i = job->source_count;
    json_int_t camera = -1;
    int placed = 0;
    struct orl_source *source = &job->sources[i];
    struct orl_exif *exif = &source->exif;
    // Calibrations that earlier programs began have no sizes.
    if (json_unpack(state, "{s:s, s:I, s?i, s?i, s:F, s:b, s:F, s:F}", "name", &name, "camera", &camera, "width",
                    &source->width, "height", &source->height, "taken_s", &exif->taken_s, "placed", &placed,
                    "latitude", &exif->latitude, "longitude", &exif->longitude) != 0 ||
        camera < 0 || (size_t)camera > i)
        return orl_fail(job->log, ORL_ERR_FORMAT, "%s/" STATE ": damaged", job->dir);
    source->name = orl_strdup(job->log, name);
    ORL_TRY_MEMORY(source->name);
    job->source_count++;
    exif->placed = placed;
    groups->of[i] = (int)camera;
    groups->size[camera]++;
    if (camera >= groups->count)
        groups->count = (int)camera + 1;
    return ORL_OK;
}

// Fills the job's sources, and `params` with the settings that the jobs read.
static enum orl_result read_state(struct orl_job *job, struct orl_prepare_params *params,
                                  struct orl_camera_groups *groups)
{
    json_t *state = NULL;
    const char *path = ORL_PATH(job->dir, STATE);
    if (!orl_path_is_file(path))
        return orl_fail(job->log, ORL_ERR_DATA, "%s: no calibration has begun: run oriel prepare "
                        "PHOTOS --out %s --until collect first", job->dir, job->dir);
    ORL_TRY(orl_json_read(job->log, path, &state));
    const json_t *photos = json_object_get(state, "photographs");
    size_t count = json_array_size(photos);
    enum orl_result result = orl_arguments_take(job->log, state, orl_prepare_options(), params, "parts");
    params->masks_dir = json_is_true(json_object_get(state, "masks")) ? "masks" : NULL;
    if (result == ORL_OK) {
        job->sources = orl_array(job->log, count + 1, sizeof *job->sources);
        groups->of = orl_array(job->log, count + 1, sizeof *groups->of);
        groups->size = orl_array(job->log, count + 1, sizeof *groups->size);
        result = job->sources && groups->of && groups->size ? ORL_OK : ORL_ERR_MEMORY;
    }
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        result = read_photo(job, json_array_get(photos, i), groups);
    json_decref(state);
    return result;
}

// --- the files of parts ---

// WORK/features-0002-of-0007, or with `extension` .tmp while it is being made (ORL_PATH).
#define PART_NAME(step, part, parts, extension) \
    ORL_PATH(WORK, "%s-%06d-of-%06d" extension, orl_part_step_names[step], (part) + 1, parts)

// The number of parts of which all are there; 0: none.
static enum orl_result find_parts(const struct orl_job *job, enum orl_part_step step, int *parts)
{
    struct orl_names names = {0};
    char form[64];
    *parts = 0;
    ORL_TRY(orl_dir_list(job->log, ORL_PATH(job->dir, WORK), &names));
    snprintf(form, sizeof form, "%s-%%d-of-%%d.db", orl_part_step_names[step]);
    for (size_t i = 0; i < names.count && !*parts; i++) {
        int part, of, there = 0;
        if (sscanf(names.items[i], form, &part, &of) != 2 || part != 1 || of < 1)
            continue;
        for (int k = 0; k < of; k++)
            there += orl_job_has(job, PART_NAME(step, k, of, ".db"));
        *parts = there == of ? of : 0;
    }
    orl_names_finish(&names);
    return ORL_OK;
}

// --- the jobs ---

struct part {
    struct orl_job *job;
    const struct orl_camera_groups *groups;
    enum orl_part_step step;
    int index, count;
    const char *temp, *temp_db, *final_db;
};

static enum orl_result run_features(const struct part *part)
{
    // Photographs that a killed run has finished are in the database; COLMAP skips them.
    return orl_features_extract(part->job, part->groups, &(struct orl_features_run){
        .database = part->temp, .part = part->index, .parts = part->count});
}

// One database of all features, with a camera a group.
static enum orl_result join_features(const struct part *part)
{
    struct orl_job *job = part->job;
    struct orl_database *db = NULL;
    int parts;
    enum orl_result result = find_parts(job, ORL_PART_FEATURES, &parts);
    if (result == ORL_OK && !parts)
        return orl_fail(job->log, ORL_ERR_DATA, "%s: features of some part are missing", job->dir);
    ORL_THEN(result, orl_match_remove_database(job, part->temp_db));
    for (int k = 0; result == ORL_OK && k < parts; k++) {
        const char *from = ORL_PATH(job->dir, "%s", PART_NAME(ORL_PART_FEATURES, k, parts, ".db"));
        if (k == 0)
            result = orl_file_copy(job->log, from, ORL_PATH(job->dir, "%s", part->temp_db));
        ORL_THEN(result, k == 0 ? orl_match_open_database(job, part->temp_db, &db)
                                : orl_database_add_photographs(db, from));
    }
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++) {
        size_t first = 0;
        while (part->groups->of[first] != part->groups->of[i])
            first++;
        result = orl_database_share_camera(db, job->sources[first].name, job->sources[i].name);
    }
    orl_database_close(&db);
    return result;
}

static enum orl_result write_pairs(const struct orl_job *job, const struct orl_pair_list *list,
                                   const struct orl_match_summary *summary)
{
    json_t *pairs = json_array();
    for (size_t i = 0; i < list->count; i++)
        json_array_append_new(pairs, json_pack("[I, I]", (json_int_t)list->items[i].a,
                                               (json_int_t)list->items[i].b));
    json_t *root = json_pack("{s:I, s:f, s:o}", "tried", (json_int_t)summary->tried, "choosing_s",
                             summary->choosing_s, "pairs", pairs);
    enum orl_result result = root ? orl_json_write(job->log, ORL_PATH(job->dir, PAIRS), root) : ORL_ERR_MEMORY;
    json_decref(root);
    return result;
}

static enum orl_result read_pairs(const struct orl_job *job, struct orl_pair_list *list,
                                  struct orl_match_summary *summary)
{
    json_t *root = NULL;
    const char *path = ORL_PATH(job->dir, PAIRS);
    enum orl_result result = orl_json_read(job->log, path, &root);
    const json_t *pairs = json_object_get(root, "pairs");
    size_t count = json_array_size(pairs);
    *list = (struct orl_pair_list){.items = orl_array(job->log, count + 1, sizeof *list->items)};
    if (result == ORL_OK && !list->items)
        result = ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        const json_t *pair = json_array_get(pairs, i);
        json_int_t a = json_integer_value(json_array_get(pair, 0));
        json_int_t b = json_integer_value(json_array_get(pair, 1));
        if (a < 0 || b <= a || (size_t)b >= job->source_count)
            result = orl_fail(job->log, ORL_ERR_FORMAT, "%s: damaged", path);
        list->items[list->count++] = (struct orl_pair){(uint32_t)a, (uint32_t)b};
    }
    *summary = (struct orl_match_summary){
        .tried = (size_t)json_integer_value(json_object_get(root, "tried")), .chosen = list->count,
        .choosing_s = json_number_value(json_object_get(root, "choosing_s"))};
    json_decref(root);
    return result;
}

static enum orl_result run_pairs(const struct part *part)
{
    struct orl_pair_list list = {0};
    struct orl_match_summary summary;
    enum orl_result result = join_features(part);
    ORL_THEN(result, orl_match_choose(part->job, part->temp_db, &list, &summary));
    ORL_THEN(result, write_pairs(part->job, &list, &summary));
    orl_pairs_finish(&list);
    return result;
}

static enum orl_result run_matches(const struct part *part)
{
    struct orl_job *job = part->job;
    struct orl_pair_list list = {0};
    struct orl_match_summary summary;
    struct orl_database *db = NULL;
    const char *from = ORL_PATH(job->dir, "%s", PART_NAME(ORL_PART_PAIRS, 0, 1, ".db"));
    bool *used = orl_array(job->log, job->source_count + 1, sizeof *used);
    enum orl_result result = used ? read_pairs(job, &list, &summary) : ORL_ERR_MEMORY;
    size_t begin = list.count * (size_t)part->index / (size_t)part->count;
    size_t end = list.count * ((size_t)part->index + 1) / (size_t)part->count;
    struct orl_pair_list own = {.items = list.items + begin, .count = end - begin};
    for (size_t i = begin; result == ORL_OK && i < end; i++)
        used[list.items[i].a] = used[list.items[i].b] = true;
    ORL_THEN(result, orl_match_remove_database(job, part->temp_db));
    ORL_THEN(result, orl_database_create_like(job->log, ORL_PATH(job->dir, "%s", part->temp_db), from, &db));
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++)
        if (used[i])
            result = orl_database_take_features(db, job->sources[i].name);
    ORL_THEN(result, orl_database_detach(db));
    orl_database_close(&db);
    ORL_THEN(result, orl_match_list(job, part->temp_db, false, &own));
    orl_pairs_finish(&list);
    free(used);
    return result;
}

static enum orl_result run_locked(const struct part *part)
{
    static enum orl_result (*const steps[])(const struct part *) = {
        [ORL_PART_FEATURES] = run_features, [ORL_PART_PAIRS] = run_pairs,
        [ORL_PART_MATCHES] = run_matches};
    struct orl_job *job = part->job;
    if (orl_job_has(job, part->final_db)) {
        orl_logf(job->log, ORL_LOG_INFO, "%s/%s: done already", job->dir, part->final_db);
        return ORL_OK;
    }
    ORL_TRY(orl_job_find_colmap(job));
    ORL_TRY(steps[part->step](part));
    ORL_TRY(orl_flush(job->log, ORL_PATH(job->dir, "%s", part->temp_db)));
    return orl_job_replace(job, part->temp_db, part->final_db);
}

static enum orl_result run_part(struct orl_job *job, const struct orl_camera_groups *groups,
                                enum orl_part_step step, int index, int count)
{
    struct part part = {.job = job, .groups = groups, .step = step, .index = index, .count = count,
                        .temp = PART_NAME(step, index, count, ".tmp"),
                        .temp_db = PART_NAME(step, index, count, ".tmp.db"),
                        .final_db = PART_NAME(step, index, count, ".db")};
    const char *stem = PART_NAME(step, index, count, "");
    bool taken = false;
    int fd = -1;
    enum orl_result result = orl_lock(job->log, ORL_PATH(job->dir, "%s.lock", stem), false, &fd, &taken);
    if (result == ORL_OK && taken)
        result = orl_fail(job->log, ORL_ERR_ARGUMENT, "%s: another oriel is at work on it", stem);
    ORL_THEN(result, run_locked(&part));
    orl_unlock(&fd);
    return result;
}

enum orl_result orl_part_run(const struct orl_log *log, const char *scene, enum orl_part_step step,
                             int part, int parts, const struct orl_progress *progress)
{
    struct orl_job job;
    struct orl_camera_groups groups = {0};
    struct orl_prepare_params params = {.out = scene};
    enum orl_result result = orl_job_attach(&job, log, &params, progress);
    if (result == ORL_OK && !orl_job_has(&job, STATE) && orl_job_has(&job, "sparse"))
        orl_logf(log, ORL_LOG_INFO, "%s: calibrated, so there is nothing left to do", job.dir);
    else if (result == ORL_OK && (result = read_state(&job, &params, &groups)) == ORL_OK)
        result = run_part(&job, &groups, step, part, parts);
    orl_camera_groups_finish(&groups);
    orl_job_close(&job);
    return result;
}

// --- joining ---

enum orl_result orl_parts_join(struct orl_job *job, struct orl_match_summary *summary, bool *joined)
{
    struct orl_pair_list list = {0};
    struct orl_database *db = NULL;
    int parts;
    enum orl_result result = find_parts(job, ORL_PART_MATCHES, &parts);
    *joined = false;
    if (result != ORL_OK || !parts)
        return result;
    result = orl_match_remove_database(job, ORL_CALIBRATE_DATABASE);
    ORL_THEN(result, orl_file_copy(job->log, ORL_PATH(job->dir, "%s", PART_NAME(ORL_PART_PAIRS, 0, 1, ".db")),
                                   ORL_PATH(job->dir, ORL_CALIBRATE_DATABASE)));
    ORL_THEN(result, read_pairs(job, &list, summary));
    ORL_THEN(result, orl_match_open_database(job, ORL_CALIBRATE_DATABASE, &db));
    for (int k = 0; result == ORL_OK && k < parts; k++)
        result = orl_database_add_matches(
            db, ORL_PATH(job->dir, "%s", PART_NAME(ORL_PART_MATCHES, k, parts, ".db")));
    *joined = result == ORL_OK;
    orl_database_close(&db);
    orl_pairs_finish(&list);
    return result;
}

enum orl_result orl_parts_remove(const struct orl_job *job)
{
    static const char *const kinds[] = {"features-", "pairs-", "matches-", "work.", "chosen."};
    struct orl_names names = {0};
    enum orl_result result = orl_dir_list(job->log, ORL_PATH(job->dir, WORK), &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++)
        for (size_t k = 0; result == ORL_OK && k < ORL_COUNT(kinds); k++)
            if (strncmp(names.items[i], kinds[k], strlen(kinds[k])) == 0)
                result = orl_dir_remove(job->log, ORL_PATH(job->dir, WORK "/%s", names.items[i]));
    orl_names_finish(&names);
    return result;
}
