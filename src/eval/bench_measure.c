// Measures one configuration: median times and memory.
#include <stdlib.h>

#include "core/memory.h"
#include "core/process.h"
#include "eval/bench_internal.h"
#include "gpu/point_raster.h"

enum { WARM_UP = 2, TRACE_FRAMES = 6, TRACE_SPANS = 1024 };

// The frames of one run.
struct run_frames {
    struct bench_job *job;
    struct orl_renderer *renderer;
    const struct orl_render_params *render;
    int width, height;
};

static enum orl_result draw(void *priv, size_t number)
{
    const struct run_frames *f = priv;
    struct orl_view view = orl_bench_resize_view(&f->job->views[number % f->job->view_count],
                                                 f->width, f->height);
    enum orl_result result = orl_timing_show_time_step(f->job->gpu, f->job->scene, f->renderer, number);
    return result != ORL_OK ? result : orl_renderer_draw(f->renderer, &view, f->render, NULL, NULL);
}

// Timing without warm-up and passes, as the benchmark's parameters say.
static struct orl_timing_params timing_params(const struct bench_job *job)
{
    return (struct orl_timing_params){.views = job->view_count, .seconds = job->params->seconds,
                                      .frames_max = job->params->frames_max,
                                      .progress = job->params->progress};
}

enum orl_result orl_bench_measure(struct bench_job *job, struct orl_renderer *renderer,
                                  const struct orl_render_params *render,
                                  struct orl_bench_run *run)
{
    struct run_frames frames = {job, renderer, render, run->width, run->height};
    struct orl_timing_params params = timing_params(job);
    params.draw = draw;
    params.priv = &frames;
    params.warm_up = WARM_UP;
    params.pass_frames = params.frames_max;
    enum orl_result result = orl_timing_take(job->gpu, &params, &run->timing);
    if (result == ORL_OK && job->scene->frame_count)
        result = orl_scene_set_frame(job->log, job->scene, -1);
    run->device_bytes = orl_gpu_bytes(job->gpu);
    run->uploaded_bytes = orl_renderer_uploaded(renderer);
    return result;
}

// --- GL_POINTS ---

// GL's clip space from world with y downwards, in column-major order.
static void clip_matrix(const struct orl_view *view, double near, double far, float out[16])
{
    const struct orl_camera *c = &view->camera;
    const struct orl_pose *pose = &view->cam_from_world;
    const double rows[4][3] = {
        {2 * c->fx / c->width, 0, 2 * c->cx / c->width - 1},
        {0, 2 * c->fy / c->height, 2 * c->cy / c->height - 1},
        {0, 0, (far + near) / (far - near)},
        {0, 0, 1}};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            double sum = i == 2 && j == 3 ? -2 * far * near / (far - near) : 0;
            for (int k = 0; k < 3; k++)
                sum += rows[i][k] * (j < 3 ? pose->r[k][j] : pose->t[k]);
            out[4 * j + i] = (float)sum;
        }
    }
}

enum orl_result orl_bench_measure_raster(struct bench_job *job, const struct orl_points *points,
                                         struct orl_bench_raster *raster)
{
    struct orl_point_raster *drawer = NULL;
    const struct orl_timing_params timing = timing_params(job);
    struct orl_pass_time times[ORL_TIMING_PASSES_MAX];
    double start, *ms = orl_array(job->log, job->params->frames_max, sizeof *ms);
    enum orl_result result = ms ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_point_raster_create(job->gpu, (const float (*)[3])points->position,
                                         (const uint8_t (*)[3])points->color, points->count,
                                         raster->width, raster->height, &drawer);
    orl_gpu_take_times(job->gpu, NULL, 0);
    orl_gpu_time_passes(job->gpu, true);
    start = orl_time_s();
    for (size_t i = 0;
         result == ORL_OK && !orl_timing_enough(&timing, raster->frames, start); i++) {
        float matrix[16];
        struct orl_view view = orl_bench_resize_view(&job->views[i % job->view_count],
                                                     raster->width, raster->height);
        clip_matrix(&view, 1e-3 * job->scene->photo_distance, 1e3 * job->scene->photo_distance,
                    matrix);
        orl_point_raster_draw(drawer, matrix);
        if (orl_gpu_take_times(job->gpu, times, ORL_TIMING_PASSES_MAX) == 0)
            result = ORL_ERR_GPU;
        else if (i >= job->view_count) // after one round of warm-up
            ms[raster->frames++] = times[0].ms;
        if (orl_progress_cancelled(job->params->progress))
            result = ORL_ERR_CANCELLED;
    }
    orl_gpu_time_passes(job->gpu, false);
    ORL_THEN(result, orl_gpu_finish(job->gpu));
    raster->raster_ms = orl_median(ms, raster->frames);
    orl_point_raster_destroy(&drawer);
    free(ms);
    return result;
}

// --- the trace ---

enum orl_result orl_bench_trace(struct bench_job *job, struct orl_renderer *renderer,
                                const struct orl_render_params *render)
{
    struct run_frames run = {job, renderer, render, job->params->sizes[0][0],
                             job->params->sizes[0][1]};
    struct bench_frame_span frames[TRACE_FRAMES];
    struct orl_pass_trace trace = {.capacity = TRACE_SPANS};
    trace.spans = orl_array(job->log, TRACE_SPANS, sizeof *trace.spans);
    if (!trace.spans)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    orl_gpu_time_passes(job->gpu, true);
    orl_gpu_trace_passes(job->gpu, &trace);
    for (size_t i = 0; result == ORL_OK && i < TRACE_FRAMES; i++) {
        frames[i].start_s = orl_time_s();
        result = orl_progress_cancelled(job->params->progress) ? ORL_ERR_CANCELLED
                                                               : draw(&run, i);
        frames[i].end_s = orl_time_s();
    }
    orl_gpu_trace_passes(job->gpu, NULL);
    orl_gpu_time_passes(job->gpu, false);
    orl_gpu_take_times(job->gpu, NULL, 0);
    if (result == ORL_OK)
        result = orl_bench_write_trace(job->log, job->params->trace, job->bench->device, &trace,
                                       frames, TRACE_FRAMES);
    free(trace.spans);
    return result;
}
