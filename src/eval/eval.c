#include "eval/eval.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/process.h"
#include "eval/internal.h"
#include "io/picture.h"
#include "render/reexpose.h"

// Timed draws of one view after a warm-up: a software renderer's are slow and
// steady enough for one.
enum { DRAWS_GPU = 3, DRAWS_SOFTWARE = 1 };

struct job {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    struct orl_renderer *renderer;
    const struct orl_scene *scene;
    const struct orl_eval_params *params;
    struct orl_eval *eval;
    size_t draws; // timed ones, of all views
};

// --- drawing and timing ---

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static enum orl_result timed_draw(struct job *job, const struct orl_view *view,
                                  struct orl_frame *frame, double *ms)
{
    double start = orl_time_s();
    const struct orl_eval_params *params = job->params;
    struct orl_render_params render = *params->render;
    render.leave_out |= ORL_LAYER_NORMAL;
    enum orl_result result =
        params->draw_radiance
            ? params->draw_radiance(params->draw_priv, view, frame)
            : orl_renderer_draw(job->renderer, view, &render, NULL, frame);
    *ms = 1e3 * (orl_time_s() - start); // drawing ends with reading back: the pipeline is empty
    return result;
}

static void add_pass_times(struct job *job)
{
    struct orl_pass_time times[ORL_EVAL_PASSES_MAX];
    struct orl_eval *eval = job->eval;
    size_t count = orl_gpu_take_times(job->gpu, times, ORL_COUNT(times));
    for (size_t i = 0; i < count && i < ORL_COUNT(times); i++) {
        size_t k = 0;
        while (k < eval->pass_count && strcmp(eval->passes[k].name, times[i].name) != 0)
            k++;
        if (k == ORL_EVAL_PASSES_MAX)
            continue;
        if (k == eval->pass_count)
            eval->passes[eval->pass_count++].name = times[i].name;
        eval->passes[k].ms += times[i].ms;
    }
}

// The last of several draws stays in *frame.
static enum orl_result draw(struct job *job, const struct orl_view *view, struct orl_frame *frame,
                            double *median_ms)
{
    double ms[DRAWS_GPU], warm_up_ms;
    int draws = orl_gpu_caps(job->gpu)->software ? DRAWS_SOFTWARE : DRAWS_GPU;
    orl_gpu_time_passes(job->gpu, false);
    enum orl_result result = timed_draw(job, view, frame, &warm_up_ms);
    orl_gpu_time_passes(job->gpu, true);
    for (int i = 0; i < draws && result == ORL_OK; i++) {
        orl_frame_finish(frame);
        result = timed_draw(job, view, frame, &ms[i]);
        job->draws++;
    }
    add_pass_times(job);
    orl_gpu_time_passes(job->gpu, false);
    if (result != ORL_OK)
        return result;
    qsort(ms, (size_t)draws, sizeof *ms, compare_doubles);
    *median_ms = ms[draws / 2];
    return ORL_OK;
}

// --- one view ---

// Aligned photographs show the scene at its reference exposure. What this one would have
// shown is the way back: by a gain guessed without its pixels (expose.h) and the vignetting
// of its lens.
static bool is_aligned(const struct orl_render_params *params, const struct orl_photo *photo)
{
    bool changed = false;
    for (int c = 0; c < 3; c++)
        changed = changed || photo->gain[c] != 1 || photo->vignette[c] != 0;
    return changed && params->alignment == ORL_ALIGNMENT_ON &&
           orl_render_option_read(orl_render_option_find("alignment"), params);
}

static enum orl_result read_photograph(const struct job *job, size_t photo,
                                       struct orl_image *image)
{
    memset(image, 0, sizeof *image);
    const struct orl_camera *camera = &job->scene->photos[photo].view.camera;
    char *path = orl_scene_photo_path(job->log, job->scene, photo);
    if (!path)
        return ORL_ERR_MEMORY;
    enum orl_result result = orl_picture_read(job->log, path, 3, image);
    if (result == ORL_OK && (image->width != camera->width || image->height != camera->height))
        result = orl_fail(job->log, ORL_ERR_DATA, "%s has %dx%d pixels, its camera %dx%d", path,
                          image->width, image->height, camera->width, camera->height);
    free(path);
    return result;
}

static enum orl_result as_photograph(const struct job *job, size_t index,
                                     struct orl_image *color, struct orl_image *rendered)
{
    if (job->params->draw_radiance)
        return orl_photo_expose(job->log, job->scene, index, color, rendered);
    const struct orl_photo *photo = &job->scene->photos[index];
    if (is_aligned(job->params->render, photo))
        orl_photo_unalign(photo, color);
    return orl_tone_srgb(job->log, color, rendered);
}

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
    const struct orl_photo *photo = &job->scene->photos[view->photo];
    struct orl_image photograph, rendered = {0};
    struct orl_frame frame = {0};
    enum orl_result result = read_photograph(job, view->photo, &photograph);
    view->width = photograph.width;
    view->height = photograph.height;
    if (result == ORL_OK)
        result = draw(job, &photo->view, &frame, &view->render_ms);
    if (result == ORL_OK && job->params->truth)
        result = compare_radiance(job, view, &frame);
    if (result == ORL_OK)
        result = as_photograph(job, view->photo, &frame.color, &rendered);
    if (result == ORL_OK)
        result = orl_metrics_compare(job->log, &rendered, &photograph, &frame.coverage,
                                     &view->metrics);
    if (result == ORL_OK && job->params->image_dir)
        result = orl_eval_write_images(job->log, job->scene, job->params, view->photo, &rendered,
                                       &photograph);
    orl_frame_finish(&frame);
    orl_image_finish(&rendered);
    orl_image_finish(&photograph);
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
                    "--test-every N or --test-list A,B", scene->dir);
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
    for (size_t i = 0; i < eval->pass_count; i++)
        eval->passes[i].ms /= (double)job.draws;
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
