#include "oriel/prepare.h"

#include <inttypes.h>
#include <stdio.h>

#include "core/file.h"
#include "core/process.h"
#include "preprocess/photos/collect.h"
#include "preprocess/scene_json.h"
#include "preprocess/stages.h"

static enum orl_result read_exposures(struct orl_job *job)
{
    const char *path = job->params->exposures;
    uint64_t hash = 0;
    if (!path)
        return ORL_OK;
    enum orl_result result = orl_exposure_list_read(job->log, path, &job->exposures);
    ORL_THEN(result, orl_file_hash(job->log, path, &hash));
    snprintf(job->exposures_hash, sizeof job->exposures_hash, "%016" PRIx64, hash);
    for (size_t k = 0; result == ORL_OK && k < job->exposures.count; k++) {
        const struct orl_exposure_list one = {&job->exposures.items[k], 1};
        bool found = false;
        for (size_t i = 0; i < job->source_count && !found; i++)
            found = orl_exposure_list_find(&one, job->sources[i].name) ||
                    orl_exposure_list_find(&one, job->sources[i].given);
        if (!found)
            orl_logf(job->log, ORL_LOG_WARNING, "%s: there is no photograph %s", path,
                     one.items[0].name);
    }
    return result;
}

// Collect always runs, because it finds out whether anything has changed.
static enum orl_result begin(struct orl_job *job)
{
    double start = orl_time_s();
    enum orl_result result;
    if ((result = orl_stages_load(job)) != ORL_OK || (result = orl_stage_collect(job)) != ORL_OK ||
        (result = read_exposures(job)) != ORL_OK)
        return result;
    return orl_stages_begin(job, orl_time_s() - start);
}

enum orl_result orl_prepare(const struct orl_log *log, const struct orl_prepare_params *params,
                            const struct orl_progress *progress)
{
    ORL_REQUIRE(log, params->input_count > 0 && params->out && *params->out);
    ORL_REQUIRE(log, params->test_every >= 0 && params->max_size >= 0);
    ORL_REQUIRE(log, params->radius_neighbours >= 0 && params->radius_neighbours <= 64);
    ORL_REQUIRE(log, params->radius_overlap >= 0 && params->radius_overlap <= 8);
    struct orl_job job;
    enum orl_result result = orl_job_open(&job, log, params, progress);
    ORL_THEN(result, begin(&job));
    if (result != ORL_OK)
        orl_job_leave(&job);
    ORL_THEN(result, orl_stages_run(&job));
    bool whole = params->until == ORL_UNTIL_END;
    if (result == ORL_OK && whole)
        result = orl_scene_json_write(&job);
    if (result == ORL_OK && !whole)
        orl_logf(log, ORL_LOG_INFO, "%s: %s; oriel plan says what is left", job.dir,
                 params->until == ORL_UNTIL_COLLECT ? "collected" : "calibrated and undistorted");
    // Only fuse reads the depth maps, so they can go once the scene is complete.
    if (result == ORL_OK && whole && params->keep == ORL_KEEP_MINIMAL)
        result = orl_job_remove(&job, "stereo");
    orl_job_close(&job);
    return result;
}
