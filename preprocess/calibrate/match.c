#include "preprocess/calibrate/match.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/process.h"
#include "preprocess/calibrate/database.h"
#include "preprocess/calibrate/pairs.h"
#include "preprocess/job/colmap_run.h"

enum {
    EXHAUSTIVE_MAX = 25,                      // photographs up to which auto matches all pairs
    FEATURES = 2 * ORL_PREEMPT_FEATURES,      // of a photograph, for choosing pairs
    RUN_PAIRS_MIN = 64, RUNS_MAX = 32,        // COLMAP runs, each of which shows progress
};

enum orl_matching orl_match_way(const struct orl_job *job)
{
    if (job->params->matching != ORL_MATCHING_AUTO)
        return job->params->matching;
    return job->source_count <= EXHAUSTIVE_MAX ? ORL_MATCHING_EXHAUSTIVE : ORL_MATCHING_RETRIEVAL;
}

static void matcher_settings(const struct orl_job *job, const char *database, bool guided,
                             struct orl_colmap_args *args)
{
    orl_colmap_arg(args, "--database_path", "%s", database);
    orl_colmap_arg(args, "--random_seed", "%u", job->params->seed);
    orl_colmap_arg(args, "--SiftMatching.use_gpu", "%d", job->colmap_cuda);
    orl_colmap_arg(args, "--SiftMatching.guided_matching", "%d", guided);
}

// Pairs that COLMAP chooses: all, or neighbours by name.
static enum orl_result match_by_colmap(struct orl_job *job, bool sequential, bool guided)
{
    struct orl_colmap_args args = {0};
    char *database = orl_job_path(job, ORL_CALIBRATE_DATABASE);
    if (!database)
        return ORL_ERR_MEMORY;
    matcher_settings(job, database, guided, &args);
    if (sequential) {
        orl_colmap_arg(&args, "--SequentialMatching.overlap", "20");
    } else {
        // Smaller blocks than COLMAP's 50 show progress; their cost is the same.
        size_t block = job->source_count / 8;
        orl_colmap_arg(&args, "--ExhaustiveMatching.block_size", "%zu", block < 5 ? 5 : block);
    }
    enum orl_result result = orl_job_colmap(job, &(struct orl_colmap_run){
        .command = sequential ? "sequential_matcher" : "exhaustive_matcher", .step = "matching",
        .share = 1, .total = 1}, &args);
    free(database);
    return result;
}

// --- pairs that Oriel chooses ---

static char *without_spaces(const struct orl_log *log, const char *name)
{
    char *copy = orl_strdup(log, name);
    for (char *c = copy; c && *c; c++)
        if (*c == ' ')
            *c = '/';
    return copy;
}

// Pairs first to first + count - 1 of the list, a line each.
static enum orl_result name_pairs(const struct orl_job *job, const struct orl_pair *pairs,
                                  size_t count, struct orl_names *lines)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        char *a = without_spaces(job->log, job->sources[pairs[i].a].name);
        char *b = without_spaces(job->log, job->sources[pairs[i].b].name);
        char *line = a && b ? orl_format(job->log, "%s %s", a, b) : NULL;
        result = line ? orl_names_add(job->log, lines, line) : ORL_ERR_MEMORY;
        free(a);
        free(b);
        free(line);
    }
    return result;
}

static enum orl_result hide_spaces(const struct orl_job *job, bool hide)
{
    struct orl_database *db = NULL;
    char *path = orl_job_path(job, ORL_CALIBRATE_DATABASE);
    enum orl_result result = path ? orl_database_open(job->log, path, &db) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_database_hide_spaces(db, hide);
    orl_database_close(&db);
    free(path);
    return result;
}

// Matches pairs first to first + count - 1 in one run of COLMAP.
static enum orl_result match_some(struct orl_job *job, const struct orl_pair_list *list,
                                  size_t first, size_t count)
{
    struct orl_colmap_args args = {0};
    struct orl_names lines = {0};
    char *database = orl_job_path(job, ORL_CALIBRATE_DATABASE);
    char *path = orl_job_path(job, ORL_CALIBRATE_WORK "/pairs.txt");
    enum orl_result result = database && path ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = name_pairs(job, list->items + first, count, &lines);
    if (result == ORL_OK)
        result = orl_job_write_list(job, path, &lines);
    if (result == ORL_OK) {
        matcher_settings(job, database, false, &args);
        orl_colmap_arg(&args, "--match_list_path", "%s", path);
        orl_colmap_arg(&args, "--match_type", "pairs");
        result = orl_job_colmap(job, &(struct orl_colmap_run){
            .command = "matches_importer", .step = "matching", .done = (double)first,
            .share = (double)count, .total = (double)list->count}, &args);
    }
    orl_names_finish(&lines);
    free(database);
    free(path);
    return result;
}

static enum orl_result match_list(struct orl_job *job, const struct orl_pair_list *list)
{
    size_t runs = list->count / RUN_PAIRS_MIN;
    runs = runs < 1 ? 1 : runs > RUNS_MAX ? RUNS_MAX : runs;
    enum orl_result result = hide_spaces(job, true);
    for (size_t i = 0; result == ORL_OK && list->count && i < runs; i++) {
        size_t first = i * list->count / runs, end = (i + 1) * list->count / runs;
        result = match_some(job, list, first, end - first);
    }
    if (result == ORL_OK)
        result = hide_spaces(job, false);
    return result;
}

static enum orl_result read_photos(const struct orl_job *job, struct orl_pair_photo *photos)
{
    struct orl_database *db = NULL;
    char *path = orl_job_path(job, ORL_CALIBRATE_DATABASE);
    enum orl_result result = path ? orl_database_open(job->log, path, &db) : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++) {
        const struct orl_exif *exif = &job->sources[i].exif;
        uint8_t *data;
        size_t count;
        result = orl_database_descriptors(db, job->sources[i].name, FEATURES, &data, &count);
        photos[i] = (struct orl_pair_photo){
            .descriptors = {data, count}, .taken_s = exif->taken_s > 0 ? exif->taken_s : NAN,
            .latitude = exif->placed ? exif->latitude : NAN,
            .longitude = exif->placed ? exif->longitude : NAN};
    }
    orl_database_close(&db);
    free(path);
    return result;
}

static enum orl_result match_retrieved(struct orl_job *job, struct orl_match_summary *summary)
{
    struct orl_pair_list list = {0};
    struct orl_pair_photo *photos = orl_array(job->log, job->source_count, sizeof *photos);
    if (!photos)
        return ORL_ERR_MEMORY;
    double start = orl_time_s();
    orl_progress_report(job->progress, "pairs", 0, 1, NULL);
    enum orl_result result = read_photos(job, photos);
    if (result == ORL_OK)
        result = orl_pairs_choose(job->log, job->progress, photos, job->source_count,
                                  job->params->seed, &list);
    for (size_t i = 0; i < job->source_count; i++)
        free((void *)photos[i].descriptors.data);
    free(photos);
    if (result == ORL_OK) {
        orl_progress_report(job->progress, "pairs", 1, 1, NULL);
        orl_logf(job->log, ORL_LOG_INFO, "calibrate: %zu of %zu pairs are worth matching",
                 list.count, job->source_count * (job->source_count - 1) / 2);
        *summary = (struct orl_match_summary){list.tried, list.count, orl_time_s() - start};
        result = match_list(job, &list);
    }
    orl_pairs_finish(&list);
    return result;
}

enum orl_result orl_match(struct orl_job *job, enum orl_matching way, bool guided,
                          struct orl_match_summary *summary)
{
    *summary = (struct orl_match_summary){0};
    enum orl_result result = way == ORL_MATCHING_RETRIEVAL
                                 ? match_retrieved(job, summary)
                                 : match_by_colmap(job, way == ORL_MATCHING_SEQUENTIAL, guided);
    if (result == ORL_OK)
        orl_progress_report(job->progress, "matching", 1, 1, NULL);
    return result;
}

enum orl_result orl_match_marked(struct orl_job *job, const bool *marked)
{
    size_t n = job->source_count, count = 0;
    struct orl_pair_list list = {.items = orl_array(job->log, n * (n - 1) / 2, sizeof *list.items)};
    if (!list.items)
        return ORL_ERR_MEMORY;
    for (size_t a = 0; a < n; a++)
        for (size_t b = a + 1; b < n; b++)
            if (marked[a] || marked[b])
                list.items[count++] = (struct orl_pair){(uint32_t)a, (uint32_t)b};
    list.count = count;
    enum orl_result result = match_list(job, &list);
    if (result == ORL_OK)
        orl_progress_report(job->progress, "matching", 1, 1, NULL);
    orl_pairs_finish(&list);
    return result;
}
