#include "preprocess/photos/doubts.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"

// --- looks, kept in .oriel/looks ---

#define LOOK_PATH(job, source) ORL_PATH((job)->dir, ".oriel/looks/%016" PRIx64, (source)->hash)

void orl_doubts_keep_look(const struct orl_job *job, const struct orl_source *source,
                          const struct orl_image *luma)
{
    struct orl_look look;
    enum orl_result result = orl_look_make(NULL, luma, &look);
    ORL_THEN(result, orl_dir_make(NULL, ORL_PATH(job->dir, ".oriel/looks")));
    ORL_THEN(result, orl_file_write(NULL, LOOK_PATH(job, source), &look, sizeof look));
    if (result != ORL_OK)
        orl_logf(job->log, ORL_LOG_DEBUG, "%s: its look is not kept", source->name);
}

bool orl_doubts_has_look(const struct orl_job *job, const struct orl_source *source)
{
    return orl_path_is_file(LOOK_PATH(job, source));
}

// Reads the photograph only when no run has kept its look.
static enum orl_result find_look(const struct orl_job *job, const struct orl_source *source,
                                 struct orl_look *look)
{
    uint8_t *data = NULL;
    size_t size = 0;
    const char *path = LOOK_PATH(job, source);
    enum orl_result result = ORL_OK;
    if (orl_progress_cancelled(job->progress))
        return ORL_ERR_CANCELLED;
    if (orl_path_is_file(path) &&
        orl_file_read(NULL, path, sizeof *look, &data, &size) == ORL_OK && size == sizeof *look) {
        memcpy(look, data, sizeof *look);
    } else {
        struct orl_image luma = {0};
        result = orl_picture_read(job->log, source->path, 1, &luma);
        ORL_THEN(result, orl_look_make(job->log, &luma, look));
        orl_image_finish(&luma);
    }
    free(data);
    return result;
}

// --- judging ---

static enum orl_result find_blurred(const struct orl_job *job, const struct orl_look *looks,
                                    struct orl_doubt *doubts)
{
    float limit;
    ORL_TRY(orl_look_blurred_below(job->log, looks, job->source_count, &limit));
    for (size_t i = 0; i < job->source_count; i++) {
        doubts[i].blurred = looks[i].sharpness < limit;
        orl_logf(job->log, ORL_LOG_DEBUG, "%s: sharpness 2^%.2f", job->sources[i].name,
                 (double)looks[i].sharpness);
    }
    return ORL_OK;
}

static void find_same(const struct orl_job *job, const struct orl_look *looks,
                      struct orl_doubt *doubts)
{
    for (size_t i = 0; i < job->source_count; i++) {
        doubts[i].same = -1;
        for (size_t k = 0; k < i && doubts[i].same < 0; k++)
            if (doubts[k].same < 0 && !doubts[k].blurred &&
                orl_look_same_picture(&looks[k], &looks[i]))
                doubts[i].same = (int)k;
    }
}

enum orl_result orl_doubts_find(const struct orl_job *job, struct orl_doubt *doubts)
{
    struct orl_look *looks = orl_array(job->log, job->source_count, sizeof *looks);
    enum orl_result result = looks ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++)
        result = find_look(job, &job->sources[i], &looks[i]);
    ORL_THEN(result, find_blurred(job, looks, doubts));
    if (result == ORL_OK)
        find_same(job, looks, doubts);
    free(looks);
    return result;
}

enum orl_result orl_count_views(const struct orl_job *job, size_t enough, size_t *views)
{
    struct orl_look *looks = orl_array(job->log, enough + 1, sizeof *looks);
    enum orl_result result = looks ? ORL_OK : ORL_ERR_MEMORY;
    *views = 0;
    for (size_t i = 0; result == ORL_OK && *views < enough && i < job->source_count; i++) {
        struct orl_look *look = &looks[*views];
        result = find_look(job, &job->sources[i], look);
        bool known = false;
        for (size_t k = 0; result == ORL_OK && k < *views && !known; k++)
            known = orl_look_same_view(&looks[k], look);
        *views += result == ORL_OK && !known;
    }
    free(looks);
    return result;
}
