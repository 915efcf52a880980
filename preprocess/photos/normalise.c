#include "preprocess/photos/normalise.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/order.h"
#include "preprocess/photos/develop.h"

// Least range of exposures for which copies are made, and how much darker than the median a
// photograph must be to be copied.
static const double RANGE_MIN_EV = 1, DARKER_MIN_EV = 0.5;
static const double BRIGHTEN_MAX_EV = 8; // beyond this, a copy holds only noise

// Finds the exposure that darker photographs are brought to; false when copies are not needed.
static bool find_target(const struct orl_job *job, double *target)
{
    double *known = orl_array(job->log, job->source_count, sizeof *known);
    size_t count = 0;
    for (size_t i = 0; known && i < job->source_count; i++)
        count += orl_source_exposure(job, &job->sources[i], &known[count]) !=
                 ORL_EXPOSURE_UNKNOWN;
    if (count)
        qsort(known, count, sizeof *known, orl_order_doubles);
    bool needed = count > 1 && known[count - 1] - known[0] >= RANGE_MIN_EV;
    *target = count ? known[count / 2] : 0;
    free(known);
    return needed;
}

// EV by which a photograph must be brightened; 0: not at all.
static double needed_ev(const struct orl_job *job, const struct orl_source *source, double target)
{
    double ev;
    if (orl_source_exposure(job, source, &ev) == ORL_EXPOSURE_UNKNOWN ||
        target - ev < DARKER_MIN_EV)
        return 0;
    return fmin(target - ev, BRIGHTEN_MAX_EV);
}

bool orl_normalise_wanted(const struct orl_job *job)
{
    double target;
    return find_target(job, &target);
}

enum orl_result orl_normalise(const struct orl_job *job, const char *dir, size_t *copies)
{
    double target;
    bool wanted = find_target(job, &target);
    *copies = 0;
    ORL_TRY(wanted ? orl_job_fresh_dir(job, dir) : ORL_OK);
    for (size_t i = 0; wanted && i < job->source_count; i++) {
        const struct orl_source *source = &job->sources[i];
        double ev = needed_ev(job, source, target);
        const char *path = ORL_PATH(job->dir, "%s/%s", dir, source->name);
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        ORL_TRY(ev > 0 ? orl_develop_write(job, source, ev, path)
                       : orl_job_link(job, source->path, path));
        *copies += ev > 0;
    }
    return ORL_OK;
}
