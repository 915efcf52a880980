#include "preprocess/expose.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "preprocess/job.h"

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Series of a photograph: that of the nearest known exposure. `sorted` ascends.
static int nearest_series(const double *sorted, size_t count, double ev)
{
    int series = 0, best = 0;
    double distance = INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (i && sorted[i] - sorted[i - 1] >= ORL_EXPOSURE_STEP_EV)
            series++;
        if (fabs(sorted[i] - ev) < distance) {
            distance = fabs(sorted[i] - ev);
            best = series;
        }
    }
    return best;
}

enum orl_result orl_exposures_group(const struct orl_log *log, struct orl_exposure *exposures,
                                    size_t count, int *series_count)
{
    size_t known = 0;
    double *sorted = orl_array(log, count, sizeof *sorted);
    if (!sorted)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        if (exposures[i].known && !exposures[i].test)
            sorted[known++] = exposures[i].ev;
    qsort(sorted, known, sizeof *sorted, compare_doubles);
    double median = known ? sorted[(known - 1) / 2] : 0; // an exposure that was really used
    *series_count = 1;
    for (size_t i = 1; i < known; i++)
        *series_count += sorted[i] - sorted[i - 1] >= ORL_EXPOSURE_STEP_EV;
    for (size_t i = 0; i < count; i++) {
        struct orl_exposure *e = &exposures[i];
        // Nothing to be relative to: as if unknown.
        e->known = e->known && known;
        e->series = nearest_series(sorted, known, e->known ? e->ev : median);
        e->ev = e->known ? e->ev - median : 0;
    }
    free(sorted);
    return ORL_OK;
}

static json_t *photo_record(const char *name, const struct orl_exposure *e)
{
    return json_pack("{s:s, s:s, s:o, s:i, s:[f,f,f]}", "name", name, "split",
                     e->test ? "test" : "train", "exposure_ev",
                     e->known ? json_real(e->ev) : json_null(), "series", e->series, "gain", 1.0,
                     1.0, 1.0);
}

enum orl_result orl_stage_expose(struct orl_job *job, json_t *record)
{
    struct orl_names train = {0}, test = {0};
    struct orl_exposure *exposures = NULL;
    int series_count = 0;
    enum orl_result result = orl_job_registered(job, &train, &test);
    if (result != ORL_OK)
        return result;
    size_t count = train.count + test.count, known = 0;
    exposures = orl_array(job->log, count, sizeof *exposures);
    json_t *photos = json_array();
    if (!exposures || !photos) {
        result = ORL_ERR_MEMORY;
        goto end;
    }
    for (size_t i = 0; i < count; i++) {
        const char *name = i < train.count ? train.items[i] : test.items[i - train.count];
        exposures[i].test = i >= train.count;
        exposures[i].known = orl_exif_exposure_ev(&orl_job_find(job, name)->exif,
                                                  &exposures[i].ev);
        known += exposures[i].known;
    }
    result = orl_exposures_group(job->log, exposures, count, &series_count);
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        json_array_append_new(photos, photo_record(i < train.count ? train.items[i]
                                                       : test.items[i - train.count],
                                                   &exposures[i]));
    json_object_set(record, "photographs", photos);
    json_object_set_new(record, "tool", json_string("libexif"));
    json_object_set_new(record, "series", json_integer(series_count));
    json_object_set_new(record, "with_exposure", json_integer((json_int_t)known));
    orl_progress_report(job->progress, "expose", 1, 1, NULL);
end:
    json_decref(photos);
    free(exposures);
    orl_names_finish(&train);
    orl_names_finish(&test);
    return result;
}
