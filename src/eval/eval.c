#include "eval/eval.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "eval/flip.h"
#include "eval/heldout.h"
#include "eval/internal.h"

// Duration of the timed frames of each view.
static const double seconds = 0.2;
enum { FRAMES_MAX = 30, PASS_FRAMES = 1 };

struct job {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    struct orl_renderer *renderer;
    const struct orl_scene *scene;
    const struct orl_eval_params *params;
    struct orl_eval *eval;
};

// --- drawing and timing ---

// One view's frames.
struct view_frames {
    struct job *job;
    const struct orl_view *view;
    struct orl_render_params render;
};

static enum orl_result draw(const struct view_frames *f, struct orl_frame *frame)
{
    const struct orl_eval_params *params = f->job->params;
    return params->draw_radiance
               ? params->draw_radiance(params->draw_priv, f->view, frame)
               : orl_renderer_draw(f->job->renderer, f->view, &f->render, NULL, frame);
}

static enum orl_result draw_again(void *priv, size_t number)
{
    (void)number;
    const struct view_frames *f = priv;
    if (!f->job->params->draw_radiance)
        return draw(f, NULL);
    struct orl_frame frame = {0}; // merging several pictures needs their pixels on the host, so
                                  // reading back is part of the time
    enum orl_result result = draw(f, &frame);
    orl_frame_finish(&frame);
    return result;
}

static void add_pass_times(struct orl_eval *eval, const struct orl_timing *timing)
{
    for (size_t i = 0; i < timing->pass_count; i++) {
        const struct orl_timing_pass *pass = &timing->passes[i];
        size_t k = 0;
        while (k < eval->pass_count && strcmp(eval->passes[k].name, pass->name) != 0)
            k++;
        if (k == ORL_TIMING_PASSES_MAX)
            continue;
        if (k == eval->pass_count)
            eval->passes[eval->pass_count++].name = pass->name;
        eval->passes[k].ms += pass->ms / (double)eval->view_count;
    }
}

// Draws the picture before the timed frames, which need no other warm-up.
static enum orl_result draw_and_time(struct job *job, const struct orl_view *view,
                                     struct orl_frame *frame, double *median_ms)
{
    struct view_frames frames = {job, view, *job->params->render};
    frames.render.leave_out |= ORL_LAYER_NORMAL;
    const struct orl_timing_params params = {
        .draw = draw_again, .priv = &frames, .views = 1, .seconds = seconds,
        .frames_max = FRAMES_MAX, .pass_frames = PASS_FRAMES, .progress = job->params->progress};
    struct orl_timing timing;
    enum orl_result result = draw(&frames, frame);
    if (result == ORL_OK)
        result = orl_timing_take(job->gpu, &params, &timing);
    if (result != ORL_OK)
        return result;
    add_pass_times(job->eval, &timing);
    *median_ms = timing.median_ms;
    return ORL_OK;
}

// --- one view ---

static enum orl_result compare_radiance(const struct job *job, struct orl_eval_view *view,
                                        const struct orl_frame *frame)
{
    struct orl_image truth;
    enum orl_result result = orl_truth_read(job->log, job->params->truth, view->photo, &truth);
    if (result == ORL_OK)
        result = orl_radiance_compare(job->log, &frame->color, &truth, &frame->coverage,
                                      &view->radiance);
    orl_image_finish(&truth);
    return result;
}

static enum orl_result measure(struct job *job, struct orl_eval_view *view)
{
    const struct orl_render_params *render =
        job->params->draw_radiance ? NULL : job->params->render;
    struct orl_heldout heldout;
    struct orl_image rendered = {0};
    struct orl_frame frame = {0};
    enum orl_result result = orl_heldout_load(job->log, job->scene, view->photo,
                                               job->params->divide > 1 ? job->params->divide : 1,
                                               &heldout);
    view->width = heldout.picture.width;
    view->height = heldout.picture.height;
    if (result == ORL_OK)
        result = draw_and_time(job, &heldout.view, &frame, &view->render_ms);
    if (result == ORL_OK && job->params->truth)
        result = compare_radiance(job, view, &frame);
    if (result == ORL_OK)
        result = orl_heldout_expose(job->log, job->scene, view->photo, render, &frame.color,
                                    &rendered);
    if (result == ORL_OK)
        result = orl_metrics_compare(job->log, &rendered, &heldout.picture, &frame.coverage,
                                     &view->metrics);
    if (result == ORL_OK)
        result = orl_flip_compare(job->log, &rendered, &heldout.picture, NULL, &view->flip);
    if (result == ORL_OK && job->params->image_dir)
        result = orl_eval_write_images(job->log, job->scene, job->params, view->photo, &rendered,
                                       &heldout.picture);
    orl_frame_finish(&frame);
    orl_image_finish(&rendered);
    orl_heldout_finish(&heldout);
    return result;
}

// --- all views ---

static void take_means(struct orl_eval *eval)
{
    struct orl_eval_view *mean = &eval->mean;
    double n = (double)eval->view_count;
    for (size_t i = 0; i < eval->view_count; i++) {
        const struct orl_metrics *m = &eval->views[i].metrics;
        mean->metrics.psnr_db += m->psnr_db / n;
        mean->metrics.psnr_cc_db += m->psnr_cc_db / n;
        mean->metrics.psnr_covered_db += m->psnr_covered_db / n;
        mean->metrics.ssim += m->ssim / n;
        mean->metrics.coverage += m->coverage / n;
        mean->metrics.completeness += m->completeness / n;
        mean->metrics.ncc_error += m->ncc_error / n;
        mean->metrics.crumbs += m->crumbs / n;
        mean->flip += eval->views[i].flip / n;
        mean->radiance.pu21_psnr_db += eval->views[i].radiance.pu21_psnr_db / n;
        mean->radiance.mu_psnr_db += eval->views[i].radiance.mu_psnr_db / n;
        mean->radiance.log2_rmse += eval->views[i].radiance.log2_rmse / n;
        mean->radiance.log2_rmse_fitted += eval->views[i].radiance.log2_rmse_fitted / n;
        mean->render_ms += eval->views[i].render_ms / n;
    }
}

static enum orl_result list_views(const struct orl_log *log, const struct orl_scene *scene,
                                  struct orl_eval *eval)
{
    eval->views = orl_array(log, scene->photo_count, sizeof *eval->views);
    if (!eval->views)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < scene->photo_count; i++)
        if (scene->photos[i].test)
            eval->views[eval->view_count++].photo = i;
    return ORL_OK;
}

enum orl_result orl_eval_check(const struct orl_log *log, const struct orl_scene *scene)
{
    for (size_t i = 0; i < scene->photo_count; i++)
        if (scene->photos[i].test)
            return ORL_OK;
    return orl_fail(log, ORL_ERR_DATA,
                    "%s: no photograph is held out to compare with; prepare the scene with "
                    "--test-every N, --test-list A,B or --test-block A:B", scene->dir);
}

static enum orl_result measure_all(struct job *job)
{
    struct orl_eval *eval = job->eval;
    const struct orl_progress *progress = job->params->progress;
    enum orl_result result = ORL_OK;
    if (job->params->image_dir)
        result = orl_dir_make(job->log, job->params->image_dir);
    for (size_t i = 0; i < eval->view_count && result == ORL_OK; i++) {
        const char *name = job->scene->photos[eval->views[i].photo].name;
        orl_progress_report(progress, job->params->method, (double)i, (double)eval->view_count,
                            name);
        if (orl_progress_cancelled(progress))
            return ORL_ERR_CANCELLED;
        result = measure(job, &eval->views[i]);
        if (result != ORL_OK)
            orl_logf(job->log, ORL_LOG_ERROR, "%s: could not be measured", name);
    }
    if (result == ORL_OK)
        orl_progress_report(progress, job->params->method, (double)eval->view_count,
                            (double)eval->view_count, NULL);
    return result;
}

enum orl_result orl_eval_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                             const struct orl_scene *scene, const struct orl_eval_params *params,
                             struct orl_eval *eval)
{
    memset(eval, 0, sizeof *eval);
    struct job job = {.log = orl_gpu_log(gpu), .gpu = gpu, .renderer = renderer, .scene = scene,
                      .params = params, .eval = eval};
    eval->scene = scene;
    eval->method = params->method;
    snprintf(eval->setting, sizeof eval->setting, "%s", params->setting ? params->setting : "");
    eval->has_truth = params->truth != NULL;
    snprintf(eval->device, sizeof eval->device, "%s", orl_gpu_caps(gpu)->renderer);
    enum orl_result result = orl_eval_check(job.log, scene);
    if (result == ORL_OK)
        result = list_views(job.log, scene, eval);
    if (result == ORL_OK)
        result = measure_all(&job);
    if (result != ORL_OK) {
        orl_eval_finish(eval);
        return result;
    }
    take_means(eval);
    return ORL_OK;
}

void orl_eval_finish(struct orl_eval *eval)
{
    if (!eval)
        return;
    free(eval->views);
    memset(eval, 0, sizeof *eval);
}
