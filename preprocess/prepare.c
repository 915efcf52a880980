#include "oriel/prepare.h"

#include <inttypes.h>
#include <stdio.h>

#include "core/file.h"
#include "core/process.h"
#include "eval/refine.h"
#include "preprocess/drawing.h"
#include "preprocess/scene_json.h"
#include "preprocess/stages.h"
#include "scene/manifest.h"

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
    ORL_TRY(orl_stages_load(job));
    ORL_TRY(orl_stage_collect(job));
    ORL_TRY(read_exposures(job));
    return orl_stages_begin(job, orl_time_s() - start);
}

// True once oriel refine has finished with this scene. Stages that are done again remove its splats.
static bool is_refined(const struct orl_job *job)
{
    return orl_job_has(job, ORL_SOFT_NAME) && !orl_job_has(job, ORL_REFINE_STATE_NAME);
}

// What oriel refine does, for the scene that has been made.
static enum orl_result refine(struct orl_job *job)
{
    struct orl_refine_params params = {ORL_REFINE_OPTIONS(ORL_OPTION_PRESET) .progress = job->progress};
    struct orl_refine_report report = {0};
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    double start = orl_time_s(), start_cpu = orl_cpu_time_s();
    params.seed = job->params->seed;
    params.max_vram_bytes = job->params->max_vram_bytes;
    enum orl_result result = orl_scene_open(job->log, job->dir, &scene);
    ORL_THEN(result, orl_choice_make(job->log, scene, ORL_SAMPLE_SRGB, NULL, &(struct orl_names){0}, &params.choice));
    if (result == ORL_OK)
        gpu = orl_drawing_device(job, scene, "refine: no soft splats are made");
    if (gpu) {
        result = orl_refine(gpu, scene, &params, &report);
        ORL_THEN(result, orl_stages_record_refine(job, start, start_cpu));
        ORL_THEN(result, orl_scene_json_write(job)); // with this record
    }
    if (result == ORL_OK && gpu)
        orl_logf(job->log, ORL_LOG_INFO, "refine: %zu splats; %zu photographs that they had not seen: %.3f dB, %.3f "
                 "without splats", report.splats, report.checks, report.psnr_db, report.before_psnr_db);
    orl_scene_destroy(&scene);
    return result;
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
    if (result == ORL_OK && whole && params->refine && is_refined(&job))
        orl_logf(log, ORL_LOG_INFO, "refine: done already");
    else if (result == ORL_OK && whole && params->refine)
        result = refine(&job);
    orl_job_close(&job);
    return result;
}
