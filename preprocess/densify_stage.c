#include "preprocess/densify_stage.h"

#include <stdio.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/order.h"
#include "preprocess/densify/densify.h"
#include "preprocess/job/colmap_run.h"

enum { COLMAP_SOURCES = 20 };

// --- COLMAP's lists, of training photographs only ---

// Chooses the training photographs that share most sparse points, shared[i], with image `ref`, best first; how many.
// `best` has room for all.
static size_t best_sources(const struct orl_colmap_model *model, const bool *train, size_t ref, const size_t *shared,
                           struct orl_ranked *best)
{
    size_t count = 0;
    for (size_t i = 0; i < model->image_count; i++)
        if (i != ref && train[i] && shared[i])
            best[count++] = (struct orl_ranked){-(double)shared[i], i};
    qsort(best, count, sizeof *best, orl_order_ranked);
    return count < COLMAP_SOURCES ? count : COLMAP_SOURCES;
}

static enum orl_result write_sources(struct orl_job *job, FILE *out,
                                     const struct orl_names *names)
{
    const struct orl_colmap_model *model;
    ORL_TRY(orl_job_sparse(job, &model));
    size_t *shared = orl_array(job->log, model->image_count, sizeof *shared);
    bool *train = orl_array(job->log, model->image_count, sizeof *train);
    struct orl_ranked *best = orl_array(job->log, model->image_count, sizeof *best);
    enum orl_result result = shared && train && best ? ORL_OK : ORL_ERR_MEMORY;
    // Names are searched once for each photograph, not for each pair of them.
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++)
        train[i] = orl_names_contain(names, model->images[i].name);
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++) {
        if (!train[i])
            continue;
        result = orl_colmap_count_shared(job->log, model, &model->images[i], shared);
        size_t count = result == ORL_OK ? best_sources(model, train, i, shared, best) : 0;
        if (!count)
            continue; // COLMAP stops at a photograph without sources
        fprintf(out, "%s\n", model->images[i].name);
        for (size_t k = 0; k < count; k++)
            fprintf(out, "%s%s", k ? ", " : "", model->images[best[k].index].name);
        fprintf(out, "\n");
    }
    free(shared);
    free(train);
    free(best);
    return result;
}

// COLMAP's own lists would include held-out photographs as sources.
static enum orl_result write_stereo_lists(struct orl_job *job, const struct orl_names *train)
{
    struct orl_atomic_file file;
    ORL_TRY(orl_job_write_list(job, ORL_PATH(job->dir, "stereo/fusion.cfg"), train));
    ORL_TRY(orl_atomic_open(job->log, ORL_PATH(job->dir, "stereo/patch-match.cfg"), &file));
    enum orl_result result = write_sources(job, file.stream, train);
    ORL_THEN(result, orl_atomic_commit(job->log, &file));
    orl_atomic_abort(&file);
    return result;
}

// --- densify ---

struct orl_densify_params orl_densify_settings(const struct orl_prepare_params *from)
{
    struct orl_densify_params params = {ORL_DENSIFY_DEFAULTS};
    params.seed = from->seed;
    params.max_vram_bytes = from->max_vram_bytes;
    if (from->quality == ORL_QUALITY_DRAFT) {
        params.sources = 5;
        params.iterations = 3;
    } else if (from->quality == ORL_QUALITY_HIGH) {
        params.sources = 10;
        params.iterations = 6;
        params.geometric_passes = 2;
    }
    return params;
}

static enum orl_result densify_gl(struct orl_job *job, const struct orl_names *train,
                                  json_t *record)
{
    struct orl_densify_params params = orl_densify_settings(job->params);
    struct orl_gpu *gpu;
    ORL_TRY(orl_job_sparse(job, &params.model));
    ORL_TRY(orl_job_gpu(job, &gpu));
    params.masks_dir = job->params->masks_dir ? ORL_PATH(job->dir, "masks") : NULL;
    const struct orl_gpu_caps *caps = orl_gpu_caps(gpu);
    json_object_set_new(record, "tool", json_string("built-in PatchMatch"));
    json_object_set_new(record, "device", json_string(caps->renderer));
    json_object_set_new(record, "settings", json_pack(
        "{s:i, s:i, s:i, s:i, s:i}", "sources", params.sources, "iterations", params.iterations,
        "geometric_passes", params.geometric_passes, "window_radius", params.window_radius,
        "window_step", params.window_step));
    orl_logf(job->log, ORL_LOG_INFO, "densify: %zu photographs on %s", train->count,
             caps->renderer);
    return orl_densify(gpu, job->dir, train, &params, job->progress);
}

static enum orl_result densify_colmap(struct orl_job *job, json_t *record)
{
    struct orl_colmap_run run = {.command = "patch_match_stereo", .step = "densify"};
    orl_colmap_arg(&run, "--workspace_path", "%s", job->dir);
    orl_colmap_arg(&run, "--random_seed", "%u", job->params->seed);
    orl_colmap_arg(&run, "--PatchMatchStereo.geom_consistency", "1");
    ORL_TRY(orl_job_colmap(job, &run));
    ORL_TRY(orl_flush(job->log, ORL_PATH(job->dir, "stereo")));
    json_object_set_new(record, "tool",
                        json_sprintf("COLMAP %s patch_match_stereo", job->colmap_version));
    orl_progress_report(job->progress, "densify", 1, 1, NULL);
    return ORL_OK;
}

// Keeps the maps of an interrupted run when they were made with the same settings.
static enum orl_result begin_stereo(const struct orl_job *job)
{
    static const char *const dirs[] = {"stereo", "stereo/depth_maps", "stereo/normal_maps",
                                       "stereo/consistency_graphs"};
    if (orl_job_has_key(job, ORL_STAGE_DENSIFY, "stereo/.oriel-key"))
        return ORL_OK;
    for (size_t i = 0; i < ORL_COUNT(dirs); i++)
        ORL_TRY(orl_job_fresh_dir(job, dirs[i]));
    return orl_job_write_key(job, ORL_STAGE_DENSIFY, "stereo/.oriel-key");
}

// Whether COLMAP makes the stereo; an error where that was asked for and it cannot.
static enum orl_result choose_densifier(struct orl_job *job, bool *use_colmap)
{
    enum orl_densifier densifier = job->params->densifier;
    ORL_TRY(densifier == ORL_DENSIFIER_GL ? ORL_OK : orl_job_find_colmap(job));
    *use_colmap = densifier == ORL_DENSIFIER_COLMAP ||
                  (densifier == ORL_DENSIFIER_AUTO && job->colmap_cuda);
    return *use_colmap && !job->colmap_cuda
               ? orl_fail(job->log, ORL_ERR_UNSUPPORTED,
                          "--densifier colmap: COLMAP %s here was built without CUDA; use gl",
                          job->colmap_version)
               : ORL_OK;
}

// Leaves SCENE/stereo with this job's key and COLMAP's lists, and maps only if they have that key.
static enum orl_result open_stereo(struct orl_job *job, struct orl_names *train)
{
    ORL_TRY(orl_job_train_names(job, train));
    ORL_TRY(begin_stereo(job));
    return write_stereo_lists(job, train);
}

enum orl_result orl_stage_densify_begin(struct orl_job *job)
{
    struct orl_names train = {0};
    struct orl_densify_params params = orl_densify_settings(job->params);
    bool use_colmap = false;
    ORL_TRY(choose_densifier(job, &use_colmap));
    if (use_colmap)
        return ORL_OK;
    ORL_TRY(orl_job_sparse(job, &params.model));
    enum orl_result result = open_stereo(job, &train);
    params.masks_dir = job->params->masks_dir ? ORL_PATH(job->dir, "masks") : NULL;
    ORL_THEN(result, orl_densify_begin(job->log, job->dir, &train, &params));
    orl_names_finish(&train);
    return result;
}

enum orl_result orl_stage_densify(struct orl_job *job, json_t *record)
{
    struct orl_names train = {0};
    bool use_colmap = false;
    enum orl_result result = choose_densifier(job, &use_colmap);
    ORL_THEN(result, open_stereo(job, &train));
    ORL_THEN(result, use_colmap ? densify_colmap(job, record) : densify_gl(job, &train, record));
    orl_names_finish(&train);
    return result;
}
