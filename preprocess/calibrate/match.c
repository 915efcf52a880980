#include "preprocess/calibrate/match.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/process.h"
#include "preprocess/calibrate/pairs.h"
#include "preprocess/job/colmap_run.h"
#include "preprocess/job/threads.h"

enum {
    EXHAUSTIVE_MAX = 25,                      // photographs up to which auto matches all pairs
    FEATURES = 2 * ORL_PAIR_FEATURES,         // of a photograph, for choosing pairs
    RUN_PAIRS = 64,                           // pairs whose features are in memory at once
    NEIGHBOURS = 20,                          // by name, on either side, that sequential matches
};
static const double VERIFYING = 0.1; // of the time that matching a pair takes

enum orl_matching orl_match_way(enum orl_matching asked, size_t photographs)
{
    if (asked != ORL_MATCHING_AUTO)
        return asked;
    return photographs <= EXHAUSTIVE_MAX ? ORL_MATCHING_EXHAUSTIVE : ORL_MATCHING_RETRIEVAL;
}

enum orl_result orl_match_open_database(const struct orl_job *job, const char *name,
                                        struct orl_database **db)
{
    return orl_database_open(job->log, ORL_PATH(job->dir, "%s", name), db);
}

enum orl_result orl_match_remove_database(const struct orl_job *job, const char *name)
{
    ORL_TRY(orl_job_remove(job, name));
    ORL_TRY(orl_job_remove(job, ORL_PATH("", "%s-wal", name)));
    return orl_job_remove(job, ORL_PATH("", "%s-shm", name));
}

// --- Oriel's own matching, on the CPU ---

struct found {
    struct orl_sift_matches matches;
    bool there; // in the database already
};

struct matching {
    const struct orl_job *job;
    const struct orl_pair *pairs;
    size_t count;
    struct orl_features *features; // owned; of each source: those of the pairs are filled
    struct found *found;           // owned; of each pair
};

static enum orl_result match_pair(void *priv, size_t index)
{
    const struct matching *m = priv;
    const struct orl_pair *pair = &m->pairs[index];
    return m->found[index].there ? ORL_OK
                                 : orl_sift_match(&m->features[pair->a], &m->features[pair->b], SIZE_MAX,
                                                  &m->found[index].matches);
}

static enum orl_result read_features(const struct matching *m, struct orl_database *db)
{
    for (size_t i = 0; i < m->count; i++) {
        const uint32_t ends[] = {m->pairs[i].a, m->pairs[i].b};
        for (int k = 0; k < 2; k++)
            if (!m->features[ends[k]].id)
                ORL_TRY(orl_database_features(db, m->job->sources[ends[k]].name, 0, &m->features[ends[k]]));
        ORL_TRY(orl_database_has_matches(db, m->features[ends[0]].id, m->features[ends[1]].id,
                                         &m->found[i].there));
    }
    return ORL_OK;
}

static enum orl_result write_matches(const struct matching *m, struct orl_database *db)
{
    enum orl_result result = orl_database_begin(db);
    for (size_t i = 0; result == ORL_OK && i < m->count; i++)
        if (!m->found[i].there)
            result = orl_database_write_matches(db, m->features[m->pairs[i].a].id, m->features[m->pairs[i].b].id,
                                                m->found[i].matches.items, m->found[i].matches.count);
    return result == ORL_OK ? orl_database_commit(db) : result;
}

enum orl_result orl_match_features(const struct orl_job *job, struct orl_database *db,
                                   const struct orl_pair_list *list, size_t first, size_t count)
{
    struct matching m = {.job = job, .pairs = list->items + first, .count = count};
    m.features = orl_array(job->log, job->source_count, sizeof *m.features);
    m.found = orl_array(job->log, count, sizeof *m.found);
    enum orl_result result = m.features && m.found ? read_features(&m, db) : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        result = orl_threads_each(&(struct orl_each){
            .work = match_pair, .priv = &m, .count = count, .progress = job->progress, .step = "matching",
            .done = (double)first, .share = (1 - VERIFYING) * (double)count, .total = (double)list->count});
        if (result == ORL_ERR_MEMORY)
            orl_logf(job->log, ORL_LOG_ERROR, "no memory to match features");
    }
    ORL_THEN(result, write_matches(&m, db));
    for (size_t i = 0; m.features && i < job->source_count; i++)
        free(m.features[i].descriptors);
    for (size_t i = 0; m.found && i < count; i++)
        free(m.found[i].matches.items);
    free(m.features);
    free(m.found);
    return result;
}

// --- matching a list of pairs ---

static char *without_spaces(const struct orl_log *log, const char *name)
{
    char *copy = orl_strdup(log, name);
    for (char *c = copy; c && *c; c++)
        if (*c == ' ')
            *c = ORL_HIDDEN_SPACE;
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

static enum orl_result hide_spaces(const struct orl_job *job, const char *database, bool hide)
{
    struct orl_database *db;
    enum orl_result result = orl_match_open_database(job, database, &db);
    ORL_THEN(result, orl_database_hide_spaces(db, hide));
    orl_database_close(&db);
    return result;
}

static enum orl_result match_features(const struct orl_job *job, const char *database,
                                      const struct orl_pair_list *list, size_t first, size_t count)
{
    struct orl_database *db;
    enum orl_result result = orl_match_open_database(job, database, &db);
    ORL_THEN(result, orl_match_features(job, db, list, first, count));
    orl_database_close(&db);
    return result;
}

// COLMAP verifies the matches of pairs first to first + count - 1, and finds those that are missing.
static enum orl_result verify(struct orl_job *job, const char *name, bool guided,
                              const struct orl_pair_list *list, size_t first, size_t count)
{
    struct orl_names lines = {0};
    double share = job->colmap_cuda ? 1 : VERIFYING;
    struct orl_colmap_run run = {.command = "matches_importer", .step = "matching",
                                 .done = (double)first + (1 - share) * (double)count,
                                 .share = share * (double)count, .total = (double)list->count};
    const char *path = ORL_PATH(job->dir, "%s.pairs.txt", name);
    enum orl_result result = name_pairs(job, list->items + first, count, &lines);
    ORL_THEN(result, orl_job_write_list(job, path, &lines));
    ORL_THEN(result, hide_spaces(job, name, true));
    if (result == ORL_OK) {
        orl_colmap_arg(&run, "--database_path", "%s/%s", job->dir, name);
        orl_colmap_arg(&run, "--random_seed", "%u", job->params->seed);
        orl_colmap_arg(&run, "--SiftMatching.use_gpu", "%d", job->colmap_cuda);
        orl_colmap_arg(&run, "--SiftMatching.guided_matching", "%d", guided);
        orl_colmap_arg(&run, "--match_list_path", "%s", path);
        orl_colmap_arg(&run, "--match_type", "pairs");
        result = orl_job_colmap(job, &run);
    }
    ORL_THEN(result, hide_spaces(job, name, false));
    orl_names_finish(&lines);
    return result;
}

enum orl_result orl_match_list(struct orl_job *job, const char *database, bool guided,
                               const struct orl_pair_list *list)
{
    for (size_t first = 0; first < list->count; first += RUN_PAIRS) {
        size_t count = list->count - first < RUN_PAIRS ? list->count - first : RUN_PAIRS;
        // A CUDA build of COLMAP matches faster on its GPU.
        if (!job->colmap_cuda)
            ORL_TRY(match_features(job, database, list, first, count));
        ORL_TRY(verify(job, database, guided, list, first, count));
    }
    return ORL_OK;
}

// --- which pairs ---

static enum orl_result read_photos(const struct orl_job *job, const char *database,
                                   struct orl_pair_photo *photos)
{
    struct orl_database *db;
    enum orl_result result = orl_match_open_database(job, database, &db);
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++) {
        const struct orl_exif *exif = &job->sources[i].exif;
        photos[i] = (struct orl_pair_photo){
            .taken_s = exif->taken_s > 0 ? exif->taken_s : NAN,
            .latitude = exif->placed ? exif->latitude : NAN,
            .longitude = exif->placed ? exif->longitude : NAN};
        result = orl_database_features(db, job->sources[i].name, FEATURES, &photos[i].features);
    }
    orl_database_close(&db);
    return result;
}

enum orl_result orl_match_choose(struct orl_job *job, const char *database,
                                 struct orl_pair_list *list, struct orl_match_summary *summary)
{
    struct orl_pair_photo *photos = orl_array(job->log, job->source_count, sizeof *photos);
    *list = (struct orl_pair_list){0};
    ORL_TRY_MEMORY(photos);
    double start = orl_time_s();
    orl_progress_report(job->progress, "pairs", 0, 1, NULL);
    enum orl_result result = read_photos(job, database, photos);
    ORL_THEN(result, orl_pairs_choose(job->log, job->progress, photos, job->source_count,
                                      job->params->seed, list));
    for (size_t i = 0; i < job->source_count; i++)
        free(photos[i].features.descriptors);
    free(photos);
    if (result == ORL_OK) {
        orl_progress_report(job->progress, "pairs", 1, 1, NULL);
        orl_logf(job->log, ORL_LOG_INFO, "calibrate: %zu of %zu pairs are worth matching",
                 list->count, job->source_count * (job->source_count - 1) / 2);
        *summary = (struct orl_match_summary){list->tried, list->count, orl_time_s() - start};
    }
    return result;
}

// All pairs; near: of neighbours by name, and of those 2, 4, 8, ... further; marked: of which one is marked.
static enum orl_result list_pairs(const struct orl_job *job, bool near, const bool *marked, struct orl_pair_list *list)
{
    size_t n = job->source_count;
    list->items = orl_array(job->log, n * (n - 1) / 2, sizeof *list->items);
    ORL_TRY_MEMORY(list->items);
    for (size_t a = 0; a < n; a++)
        for (size_t b = a + 1; b < n; b++) {
            size_t apart = b - a;
            if ((!near || apart <= NEIGHBOURS || (apart & (apart - 1)) == 0) && (!marked || marked[a] || marked[b]))
                list->items[list->count++] = (struct orl_pair){(uint32_t)a, (uint32_t)b};
        }
    return ORL_OK;
}

enum orl_result orl_match(struct orl_job *job, enum orl_matching way, bool guided, const bool *marked,
                          struct orl_match_summary *summary)
{
    struct orl_pair_list list = {0};
    enum orl_result result = way == ORL_MATCHING_RETRIEVAL
                                 ? orl_match_choose(job, ORL_CALIBRATE_DATABASE, &list, summary)
                                 : list_pairs(job, way == ORL_MATCHING_SEQUENTIAL, marked, &list);
    ORL_THEN(result, orl_match_list(job, ORL_CALIBRATE_DATABASE, guided, &list));
    if (result == ORL_OK)
        orl_progress_report(job->progress, "matching", 1, 1, NULL);
    orl_pairs_finish(&list);
    return result;
}
