#include "preprocess/calibrate/raw_matches.h"

#include <stdlib.h>

#include "core/memory.h"

struct found {
    uint32_t (*matches)[2]; // owned; indices of features
    size_t count;
    bool there; // in the database already
};

struct work {
    const struct orl_pair *pairs;
    size_t count;
    struct orl_features *photos; // owned; those of the pairs are filled
    struct found *found;         // owned; of each pair
};

static enum orl_result match_pair(void *priv, size_t index)
{
    const struct work *work = priv;
    if (work->found[index].there)
        return ORL_OK;
    const struct orl_features *a = &work->photos[work->pairs[index].a];
    const struct orl_features *b = &work->photos[work->pairs[index].b];
    struct found *found = &work->found[index];
    size_t least = a->count < b->count ? a->count : b->count;
    int16_t *wide = orl_array(NULL, a->count + b->count, ORL_SIFT_SIZE * sizeof *wide);
    struct orl_nearest *nearest = orl_array(NULL, a->count + b->count, sizeof *nearest);
    found->matches = orl_array(NULL, least, sizeof *found->matches);
    bool ok = wide && nearest && found->matches;
    if (ok) {
        int16_t *wide_b = wide + a->count * ORL_SIFT_SIZE;
        struct orl_nearest *of_b = nearest + a->count;
        orl_sift_widen(a->descriptors, a->count, wide);
        orl_sift_widen(b->descriptors, b->count, wide_b);
        orl_sift_nearest(wide, a->count, wide_b, b->count, nearest, of_b);
        for (size_t i = 0; i < a->count; i++) {
            if (!orl_sift_is_match(nearest, of_b, i))
                continue;
            found->matches[found->count][0] = (uint32_t)i;
            found->matches[found->count++][1] = nearest[i].index;
        }
    }
    free(wide);
    free(nearest);
    return ok ? ORL_OK : ORL_ERR_MEMORY;
}

static enum orl_result read_features(struct work *work, struct orl_database *db,
                                     const char *const *names)
{
    for (size_t i = 0; i < work->count; i++) {
        const uint32_t ends[] = {work->pairs[i].a, work->pairs[i].b};
        for (int k = 0; k < 2; k++)
            if (!work->photos[ends[k]].id)
                ORL_TRY(orl_database_features(db, names[ends[k]], &work->photos[ends[k]]));
        ORL_TRY(orl_database_has_matches(db, work->photos[ends[0]].id,
                                         work->photos[ends[1]].id, &work->found[i].there));
    }
    return ORL_OK;
}

static enum orl_result write_all(const struct work *work, struct orl_database *db)
{
    enum orl_result result = orl_database_begin(db);
    for (size_t i = 0; result == ORL_OK && i < work->count; i++)
        if (!work->found[i].there)
            result = orl_database_write_matches(db, work->photos[work->pairs[i].a].id,
                                                work->photos[work->pairs[i].b].id,
                                                work->found[i].matches, work->found[i].count);
    return result == ORL_OK ? orl_database_commit(db) : result;
}

enum orl_result orl_raw_matches_write(const struct orl_log *log, const struct orl_each *progress,
                                      struct orl_database *db, const char *const *names,
                                      size_t photo_count, const struct orl_pair *pairs,
                                      size_t count)
{
    struct work work = {.pairs = pairs, .count = count};
    work.photos = orl_array(log, photo_count, sizeof *work.photos);
    work.found = orl_array(log, count, sizeof *work.found);
    enum orl_result result = work.photos && work.found ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, read_features(&work, db, names));
    if (result == ORL_OK) {
        struct orl_each each = *progress;
        each.work = match_pair, each.priv = &work, each.count = count, each.step = "matching";
        result = orl_threads_each(&each);
        if (result == ORL_ERR_MEMORY)
            orl_logf(log, ORL_LOG_ERROR, "no memory to match features");
    }
    ORL_THEN(result, write_all(&work, db));
    for (size_t i = 0; work.photos && i < photo_count; i++)
        free(work.photos[i].descriptors);
    for (size_t i = 0; work.found && i < count; i++)
        free(work.found[i].matches);
    free(work.photos);
    free(work.found);
    return result;
}
