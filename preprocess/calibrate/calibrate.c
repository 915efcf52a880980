// Calibrate: camera positions and intrinsics, by COLMAP's structure from motion.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "preprocess/calibrate/database.h"
#include "preprocess/calibrate/features.h"
#include "preprocess/calibrate/mapper.h"
#include "preprocess/calibrate/match.h"
#include "preprocess/calibrate/parts.h"
#include "preprocess/job/colmap_run.h"
#include "preprocess/photos/doubts.h"
#include "preprocess/photos/normalise.h"

#define WORK ORL_CALIBRATE_WORK
#define NORMALISED ORL_CALIBRATE_NORMALISED
#define DONE ".oriel/calibrate"

enum {
    COSTLY_MAX = 60,   // photographs up to which affine-shape features are tried
    LEFT_OUT_MAX = 20, // photographs left out that are matched with all others
};

// A model that the mapper made.
struct candidate {
    char *path; // owned; its folder, below WORK; NULL: there is none
    struct orl_colmap_model model;
    bool bent;  // has it a camera whose distortion turns back on itself?
    int features; // of struct calibration: those that it was made from
};

struct calibration {
    struct orl_job *job;
    struct orl_camera_groups groups;
    struct candidate best; // so far
    enum orl_matching way; // of choosing pairs
    struct orl_match_summary pairs;
    enum orl_mapper mapper;
    bool straight;       // distortion is taken to be none from now on
    bool whole;          // features are taken of whole photographs from now on, whatever their masks
    int tries;           // mapper runs, for folder names
    int features;        // counts the databases: a new one has other features and numbers
};

#define LENS_ADVICE "COLMAP finds a camera that no ordinary lens makes: panoramas must be cut into " \
    "flat views, and photographs of a fisheye lens calibrated with its model (COLMAP's OPENCV_FISHEYE) " \
    "and given to oriel import"

// --- the mapper ---

static void candidate_finish(struct candidate *candidate)
{
    free(candidate->path);
    orl_colmap_finish(&candidate->model);
    *candidate = (struct candidate){0};
}

static bool is_better(const struct candidate *a, const struct candidate *b)
{
    return !b->path || a->model.image_count > b->model.image_count ||
           (a->model.image_count == b->model.image_count &&
            a->model.point_count > b->model.point_count);
}

// Photographs in the best model so far.
static size_t registered(const struct calibration *c)
{
    return c->best.model.image_count;
}

static void say(const struct calibration *c, const char *what)
{
    orl_logf(c->job->log, ORL_LOG_INFO, "calibrate: %zu of %zu photographs register; %s",
             registered(c), c->job->source_count, what);
}

// Takes the model in `path` if it is better than the best so far. ORL_ERR_FORMAT: it has a camera that no
// lens makes, and does not count.
static enum orl_result consider(struct calibration *c, const char *path)
{
    struct candidate candidate = {.features = c->features};
    enum orl_result result = orl_colmap_read(NULL, path, &candidate.model);
    if (result == ORL_ERR_FORMAT)
        return result;
    if (result != ORL_OK)
        return orl_fail(c->job->log, result, "%s: the model cannot be read", path);
    for (size_t i = 0; i < candidate.model.camera_count; i++)
        candidate.bent |= !orl_colmap_camera_reaches_corners(&candidate.model.cameras[i]);
    candidate.path = orl_strdup(c->job->log, path);
    if (candidate.path && is_better(&candidate, &c->best)) {
        struct candidate worse = c->best;
        c->best = candidate;
        candidate = worse;
    }
    candidate_finish(&candidate);
    return c->best.path ? ORL_OK : ORL_ERR_MEMORY;
}

// `out` is a model itself, or holds some in numbered folders. One that does not count, which the
// photographs that joined last may have bent, matters only if there is no other.
static enum orl_result consider_all(struct calibration *c, const char *out)
{
    const struct orl_log *log = c->job->log;
    struct orl_colmap_model model;
    struct orl_names names;
    char odd[ORL_PATH_SIZE] = ""; // the last that does not count
    enum orl_result result = orl_dir_list(log, out, &names);
    bool one = result == ORL_OK && (orl_names_contain(&names, "cameras.bin") ||
                                    orl_names_contain(&names, "cameras.txt"));
    for (size_t i = 0; result == ORL_OK && i < (one ? 1 : names.count); i++) {
        const char *path = one ? out : ORL_PATH(out, "%s", names.items[i]);
        if (orl_path_is_dir(path))
            result = consider(c, path);
        if (result == ORL_ERR_FORMAT) {
            say(c, "COLMAP's next model has a camera that no ordinary lens makes and does not count");
            orl_path_print(odd, "", "%s", path);
            result = ORL_OK;
        }
    }
    // Another mapper may find an ordinary one yet, and beside a straight one there is the bent one.
    bool last = c->mapper == ORL_MAPPER_INCREMENTAL && !c->straight;
    if (result == ORL_OK && *odd && !c->best.path && last) {
        result = orl_colmap_read(log, odd, &model); // for its word on what is wrong
        if (result == ORL_ERR_FORMAT)
            result = orl_fail(log, ORL_ERR_DATA, "%s: " LENS_ADVICE, odd);
    }
    orl_names_finish(&names);
    return result;
}

// A new folder below WORK for a mapper's models.
static enum orl_result begin_try(struct calibration *c, char path[ORL_PATH_SIZE])
{
    const char *name = ORL_PATH(WORK, "models-%d", c->tries++);
    orl_path_print(path, c->job->dir, "%s", name);
    return orl_job_fresh_dir(c->job, name);
}

// The hierarchical mapper's model, adjusted as a whole, takes the place of the one that it joined.
static enum orl_result refine(struct calibration *c)
{
    struct candidate joined = c->best;
    char out[ORL_PATH_SIZE];
    ORL_TRY(begin_try(c, out));
    ORL_TRY(orl_mapper_refine(c->job, joined.path, out, c->straight));
    c->best = (struct candidate){0};
    enum orl_result result = consider_all(c, out);
    candidate_finish(&joined);
    return result;
}

static enum orl_result map(struct calibration *c, bool loose, const char *from)
{
    char out[ORL_PATH_SIZE];
    ORL_TRY(begin_try(c, out));
    ORL_TRY(orl_mapper_run(c->job, &(struct orl_mapper_run){
                .mapper = c->mapper, .from = from, .out = out, .loose = loose,
                .straight = c->straight}));
    ORL_TRY(consider_all(c, out));
    if (c->mapper == ORL_MAPPER_HIERARCHICAL && !loose && !from && c->best.path)
        ORL_TRY(refine(c));
    orl_progress_report(c->job->progress, "mapping", 1, 1, NULL);
    return ORL_OK;
}

// --- attempts ---

static bool enough(const struct calibration *c)
{
    return registered(c) >= 3 && 2 * registered(c) >= c->job->source_count;
}

static bool most(const struct calibration *c)
{
    return 5 * registered(c) >= 4 * c->job->source_count;
}

static bool all(const struct calibration *c)
{
    return registered(c) == c->job->source_count;
}

// Marks the database as whole for these inputs and settings.
static enum orl_result set_mark(const struct calibration *c, bool matched)
{
    if (!matched)
        return orl_job_remove(c->job, WORK "/matched");
    ORL_TRY(orl_flush(c->job->log, ORL_PATH(c->job->dir, WORK)));
    return orl_job_write_key(c->job, ORL_STAGE_CALIBRATE, WORK "/matched");
}

static enum orl_result extract_all(const struct calibration *c, bool costly)
{
    ORL_TRY(orl_features_link_masks(c->job));
    return orl_features_extract(c->job, &c->groups, &(struct orl_features_run){
        .database = ORL_CALIBRATE_STEM, .parts = 1, .costly = costly, .whole = c->whole});
}

// A new database of other features.
static enum orl_result begin_again(struct calibration *c, enum orl_matching way, bool costly)
{
    c->features++;
    ORL_TRY(set_mark(c, false));
    ORL_TRY(orl_match_remove_database(c->job, ORL_CALIBRATE_DATABASE));
    ORL_TRY(extract_all(c, costly));
    ORL_TRY(orl_match(c->job, way, costly, NULL, &c->pairs));
    return map(c, false, NULL);
}

// More features that bear wider baselines, for sets that hardly overlap.
static enum orl_result try_costly(struct calibration *c)
{
    say(c, "trying affine-shape features and guided matching");
    ORL_TRY(begin_again(c, ORL_MATCHING_EXHAUSTIVE, true));
    return enough(c) ? ORL_OK : map(c, true, NULL);
}

static enum orl_result go_on_mapping(struct calibration *c, bool loose)
{
    return map(c, loose, ORL_PATH("", "%s", c->best.path)); // which map may release
}

// The poses of the model found are good: photographs with fewer matches may join it. The mapper goes
// on only with a model of the features that are in the database.
static enum orl_result join_more(struct calibration *c)
{
    if (registered(c) < 3 || all(c) || c->best.features != c->features)
        return ORL_OK;
    say(c, "letting photographs with fewer matches join");
    return go_on_mapping(c, true);
}

// The mappers for very many photographs start from all of them at once, and may fail where one that
// adds photograph after photograph does not.
static enum orl_result map_one_by_one(struct calibration *c)
{
    if (c->mapper == ORL_MAPPER_INCREMENTAL || enough(c))
        return ORL_OK;
    say(c, "mapping incrementally");
    c->mapper = ORL_MAPPER_INCREMENTAL;
    return map(c, false, NULL);
}

// What retrieval gave too few of the right partners, if there are few such photographs.
static enum orl_result match_left_out(struct calibration *c)
{
    size_t left_out = c->job->source_count - registered(c);
    if (c->way != ORL_MATCHING_RETRIEVAL || !enough(c) || !left_out || left_out > LEFT_OUT_MAX)
        return ORL_OK;
    say(c, "matching the others with all");
    bool *marked = orl_array(c->job->log, c->job->source_count, sizeof *marked);
    ORL_TRY_MEMORY(marked);
    for (size_t i = 0; i < c->job->source_count; i++)
        marked[i] = !orl_colmap_image_by_name(&c->best.model, c->job->sources[i].name);
    enum orl_result result = set_mark(c, false);
    ORL_THEN(result, orl_match(c->job, ORL_MATCHING_EXHAUSTIVE, false, marked, NULL));
    ORL_THEN(result, set_mark(c, true));
    free(marked);
    return result == ORL_OK ? go_on_mapping(c, false) : result;
}

static enum orl_result match_all(struct calibration *c)
{
    if (c->way == ORL_MATCHING_EXHAUSTIVE || enough(c))
        return ORL_OK;
    say(c, "matching all pairs");
    ORL_TRY(orl_match(c->job, ORL_MATCHING_EXHAUSTIVE, false, NULL, NULL));
    return map(c, false, NULL);
}

// A plain subject alone may have too few features. Where it stood still, its surroundings tell as well from where it was
// photographed; on a turntable they tell nothing, and fewer photographs register.
static enum orl_result pass_over_masks(struct calibration *c)
{
    if (!c->job->params->masks_dir || most(c))
        return ORL_OK;
    say(c, "taking features of whole photographs, not of what masks show alone");
    c->whole = true;
    ORL_TRY(begin_again(c, c->way, false));
    ORL_TRY(join_more(c));
    c->whole = c->best.features == c->features;
    return ORL_OK;
}

static enum orl_result try_hard(struct calibration *c)
{
    enum orl_result result = map_one_by_one(c);
    ORL_THEN(result, match_left_out(c));
    ORL_THEN(result, join_more(c));
    ORL_THEN(result, match_all(c));
    // Where most are missing another pair may be the better start.
    if (result == ORL_OK && !most(c)) {
        say(c, "starting from narrower baselines and fewer inliers");
        result = map(c, true, NULL);
    }
    ORL_THEN(result, pass_over_masks(c));
    if (result == ORL_OK && !enough(c) && c->job->source_count <= COSTLY_MAX) {
        result = try_costly(c);
        ORL_THEN(result, join_more(c));
    }
    return result;
}

// Where nothing tells a lens's distortion (a small thing in the middle of each photograph, gloss) the
// mapper may find one that no lens has, and of the photographs the middle alone would be left. Better
// none then, if about as many photographs register.
static enum orl_result straighten(struct calibration *c)
{
    struct candidate bent = c->best;
    if (!bent.bent)
        return ORL_OK;
    say(c, "with a distortion that no lens has; trying without");
    c->straight = true;
    c->best = (struct candidate){0};
    enum orl_result result = map(c, false, NULL);
    bool better = result == ORL_OK && c->best.path && !c->best.bent &&
                  4 * registered(c) >= 3 * bent.model.image_count;
    candidate_finish(better ? &bent : &c->best);
    if (!better)
        c->best = bent;
    return result;
}

static enum orl_result normalise(const struct calibration *c)
{
    size_t copies;
    enum orl_result result = orl_normalise(c->job, NORMALISED, &copies);
    if (result == ORL_OK && copies)
        orl_logf(c->job->log, ORL_LOG_INFO,
                 "calibrate: exposures differ; features of %zu photographs come from brightened "
                 "copies", copies);
    return result;
}

// A run that was ended while COLMAP verified further matches has left names without their spaces (match.c).
static enum orl_result show_spaces(const struct calibration *c)
{
    struct orl_database *db;
    ORL_TRY(orl_database_open(c->job->log, ORL_PATH(c->job->dir, WORK "/database.db"), &db));
    enum orl_result result = orl_database_hide_spaces(db, false);
    orl_database_close(&db);
    return result;
}

// Features and matches survive an interruption of the mapper. Those that jobs have made are used.
static enum orl_result begin_database(struct calibration *c)
{
    bool joined = false;
    if (orl_job_has_key(c->job, ORL_STAGE_CALIBRATE, WORK "/matched")) {
        orl_logf(c->job->log, ORL_LOG_INFO, "calibrate: features and matches are there already");
        return show_spaces(c);
    }
    if (orl_parts_begun(c->job))
        ORL_TRY(orl_parts_join(c->job, &c->pairs, &joined));
    if (joined) {
        orl_logf(c->job->log, ORL_LOG_INFO, "calibrate: using the features and matches of jobs");
        return set_mark(c, true);
    }
    ORL_TRY(orl_job_fresh_dir(c->job, WORK));
    ORL_TRY(normalise(c));
    ORL_TRY(extract_all(c, false));
    ORL_TRY(orl_match(c->job, c->way, false, NULL, &c->pairs));
    return set_mark(c, true);
}

static enum orl_result find_parallax(const struct calibration *c, bool *parallax)
{
    struct orl_database *db;
    ORL_TRY(orl_database_open(c->job->log, ORL_PATH(c->job->dir, WORK "/database.db"), &db));
    enum orl_result result = orl_database_has_parallax(db, parallax);
    orl_database_close(&db);
    return result;
}

// Cameras that stood still, one or some all around, are a common mistake.
static enum orl_result fail_to_place(const struct calibration *c)
{
    const struct orl_job *job = c->job;
    size_t views;
    ORL_TRY(orl_count_views(job, 3, &views));
    const char *why =
        views < 2 ? "all show one view, as of a camera that stood still, and tell no depth: take "
                    "them from different positions, a step or two from one to the next"
        : views < 3 ? "all show one of two views, as of two cameras that stood still, which is too "
                      "few: take them from more positions, a step or two from one to the next"
                    : "take more, with at least two thirds of overlap from one to the next, sharp, "
                      "with texture, and from different positions; a few cameras fixed around a "
                      "scene stand too far apart";
    return orl_fail(job->log, ORL_ERR_DATA,
                    "only %zu of %zu photographs could be placed relative to each other, and three "
                    "are needed: %s (what was done is kept in %s)", registered(c),
                    job->source_count, why, job->dir);
}

// Some of the photographs of a camera that turned on one spot may still be placed, somewhere.
static enum orl_result check_parallax(const struct calibration *c)
{
    bool parallax = true;
    if (!most(c))
        ORL_TRY(find_parallax(c, &parallax));
    return parallax ? ORL_OK
                    : orl_fail(c->job->log, ORL_ERR_DATA,
                               "only %zu of %zu photographs could be placed relative to each other, and all "
                               "that have something in common look as if the camera turned on one spot, or "
                               "show one flat thing, and tell no depth: take them from different positions, "
                               "a step or two from one to the next (what was done is kept in %s)",
                               registered(c), c->job->source_count, c->job->dir);
}

static enum orl_result finish(struct calibration *c)
{
    const struct orl_job *job = c->job;
    if (registered(c) < 3)
        return fail_to_place(c);
    ORL_TRY(check_parallax(c));
    const char *model = ORL_PATH(job->dir, WORK "/model");
    ORL_TRY(orl_dir_remove(job->log, model));
    ORL_TRY(orl_job_remove(job, NORMALISED));
    ORL_TRY(orl_parts_remove(job));
    if (rename(c->best.path, model) != 0)
        return orl_fail(job->log, ORL_ERR_IO, "%s: %s", model, strerror(errno));
    for (int i = 0; i < c->tries; i++)
        ORL_TRY(orl_dir_remove(job->log, ORL_PATH(job->dir, WORK "/models-%d", i)));
    return orl_job_replace(job, WORK, DONE);
}

static void name_left_out(const struct calibration *c, json_t *record)
{
    const struct orl_colmap_model *model = &c->best.model;
    json_t *left_out = json_array();
    for (size_t i = 0; i < c->job->source_count; i++) {
        const char *name = c->job->sources[i].name;
        if (orl_colmap_image_by_name(model, name))
            continue;
        orl_logf(c->job->log, ORL_LOG_WARNING, "%s: cannot be placed, left out", name);
        json_array_append_new(left_out, json_string(name));
    }
    json_object_set_new(record, "registered", json_integer((json_int_t)model->image_count));
    json_object_set_new(record, "sparse_points", json_integer((json_int_t)model->point_count));
    json_object_set_new(record, "left_out", left_out);
}

// Panoramas and fisheye pictures end as cameras of very short focal length.
static enum orl_result check_lenses(const struct calibration *c)
{
    const double least = 0.2; // of the larger side: 136 degrees
    for (size_t i = 0; i < c->best.model.camera_count; i++) {
        const struct orl_camera *camera = &c->best.model.cameras[i].pinhole;
        int larger = camera->width > camera->height ? camera->width : camera->height;
        if (camera->fx < least * larger)
            return orl_fail(c->job->log, ORL_ERR_DATA, "a focal length of %.4g pixels for "
                            "photographs of %dx%d: " LENS_ADVICE, camera->fx, camera->width,
                            camera->height);
    }
    return ORL_OK;
}

static void write_record(const struct calibration *c, json_t *record)
{
    json_object_set_new(record, "tool", json_sprintf("COLMAP %s", c->job->colmap_version));
    json_object_set_new(record, "cameras", json_integer(c->groups.count));
    json_object_set_new(record, "matching", json_string(orl_matching_names[c->way]));
    json_object_set_new(record, "mapper", json_string(orl_mapper_names[c->mapper]));
    if (c->pairs.tried)
        json_object_set_new(record, "pairs",
                            json_pack("{s:I, s:I, s:f}", "tried", (json_int_t)c->pairs.tried,
                                      "chosen", (json_int_t)c->pairs.chosen, "choosing_s",
                                      c->pairs.choosing_s));
    name_left_out(c, record);
}

enum orl_result orl_stage_calibrate(struct orl_job *job, json_t *record)
{
    static const char *const ways[] = {
        [ORL_MATCHING_EXHAUSTIVE] = "all pairs", [ORL_MATCHING_SEQUENTIAL] = "neighbours by name",
        [ORL_MATCHING_RETRIEVAL] = "pairs that look alike"};
    struct calibration c = {.job = job, .way = orl_match_way(job->params->matching, job->source_count)};
    ORL_TRY(orl_job_find_colmap(job));
    ORL_TRY(orl_mapper_choose(job, &c.mapper));
    enum orl_result result = orl_camera_groups_find(job, &c.groups);
    if (result == ORL_OK)
        orl_logf(job->log, ORL_LOG_INFO, "calibrate: %zu photographs, %d camera%s, %s matching (%s)",
                 job->source_count, c.groups.count, c.groups.count == 1 ? "" : "s",
                 orl_matching_names[c.way], ways[c.way]);
    ORL_THEN(result, begin_database(&c));
    ORL_THEN(result, map(&c, false, NULL));
    ORL_THEN(result, all(&c) ? ORL_OK : try_hard(&c));
    ORL_THEN(result, straighten(&c));
    ORL_THEN(result, check_lenses(&c));
    ORL_THEN(result, finish(&c));
    if (result == ORL_OK)
        write_record(&c, record);
    orl_camera_groups_finish(&c.groups);
    candidate_finish(&c.best);
    return result;
}

enum orl_result orl_calibrate_begin(struct orl_job *job)
{
    struct calibration c = {.job = job};
    if (orl_parts_begun(job))
        return ORL_OK;
    enum orl_result result = orl_camera_groups_find(job, &c.groups);
    ORL_THEN(result, orl_job_fresh_dir(job, WORK));
    ORL_THEN(result, normalise(&c));
    ORL_THEN(result, orl_parts_begin(job, &c.groups));
    orl_camera_groups_finish(&c.groups);
    return result;
}
