// Medians of one configuration.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/process.h"
#include "eval/bench_internal.h"
#include "gpu/point_raster.h"

enum { WARM_UP = 2, FRAMES_MIN = 3, TRACE_FRAMES = 6, TRACE_SPANS = 1024 };

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double orl_bench_median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return count ? 0.5 * (values[(count - 1) / 2] + values[count / 2]) : 0;
}

// One frame of the run, the device drained.
static enum orl_result draw(struct bench_job *job, struct orl_renderer *renderer,
                            const struct orl_render_params *render,
                            const struct orl_bench_run *run, size_t number, double *ms)
{
    struct orl_view view =
        orl_bench_resize_view(&job->views[number % job->view_count], run->width, run->height);
    if (orl_progress_cancelled(job->params->progress))
        return ORL_ERR_CANCELLED;
    double start = orl_time_s();
    enum orl_result result = orl_renderer_draw(renderer, &view, render, NULL, NULL);
    *ms = 1e3 * (orl_time_s() - start);
    return result;
}

static bool enough(const struct bench_job *job, size_t frames, double start_s)
{
    // All views as often as each other.
    return frames >= job->params->frames_max ||
           (frames >= FRAMES_MIN && frames % job->view_count == 0 &&
            orl_time_s() - start_s >= job->params->seconds);
}

static enum orl_result measure_frames(struct bench_job *job, struct orl_renderer *renderer,
                                      const struct orl_render_params *render,
                                      struct orl_bench_run *run, double *ms)
{
    enum orl_result result = ORL_OK;
    double start = orl_time_s();
    for (run->frames = 0; result == ORL_OK && !enough(job, run->frames, start); run->frames++)
        result = draw(job, renderer, render, run, run->frames, &ms[run->frames]);
    for (size_t i = 0; i < run->frames; i++)
        run->slowest_ms = fmax(run->slowest_ms, ms[i]);
    run->frame_ms = orl_bench_median(ms, run->frames);
    return result;
}

// Adds one frame's passes to the columns; `names` grows.
static void note_passes(struct bench_job *job, struct orl_bench_run *run, double *columns,
                        size_t frame)
{
    struct orl_pass_time times[ORL_BENCH_PASSES_MAX];
    size_t count = orl_gpu_take_times(job->gpu, times, ORL_BENCH_PASSES_MAX);
    for (size_t i = 0; i < count && i < ORL_BENCH_PASSES_MAX; i++) {
        size_t k = 0;
        while (k < run->pass_count && strcmp(run->passes[k].name, times[i].name) != 0)
            k++;
        if (k == ORL_BENCH_PASSES_MAX)
            continue;
        if (k == run->pass_count)
            run->passes[run->pass_count++].name = times[i].name;
        columns[k * job->params->frames_max + frame] = times[i].ms;
    }
}

static enum orl_result measure_passes(struct bench_job *job, struct orl_renderer *renderer,
                                      const struct orl_render_params *render,
                                      struct orl_bench_run *run)
{
    size_t rows = job->params->frames_max, frames = run->frames;
    double unused, *columns = orl_array(job->log, rows * ORL_BENCH_PASSES_MAX, sizeof *columns);
    if (!columns)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    orl_gpu_take_times(job->gpu, NULL, 0);
    orl_gpu_time_passes(job->gpu, true);
    for (size_t i = 0; result == ORL_OK && i < frames; i++) {
        result = draw(job, renderer, render, run, i, &unused);
        note_passes(job, run, columns, i);
    }
    orl_gpu_time_passes(job->gpu, false);
    for (size_t k = 0; k < run->pass_count; k++)
        run->passes[k].ms = orl_bench_median(&columns[k * rows], frames);
    free(columns);
    return result;
}

enum orl_result orl_bench_measure(struct bench_job *job, struct orl_renderer *renderer,
                                  const struct orl_render_params *render,
                                  struct orl_bench_run *run)
{
    double unused, *ms = orl_array(job->log, job->params->frames_max, sizeof *ms);
    enum orl_result result = ms ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < WARM_UP * job->view_count; i++)
        result = draw(job, renderer, render, run, i, &unused);
    if (result == ORL_OK)
        result = measure_frames(job, renderer, render, run, ms);
    if (result == ORL_OK)
        result = measure_passes(job, renderer, render, run);
    run->device_bytes = orl_gpu_bytes(job->gpu);
    free(ms);
    return result;
}

// --- GL_POINTS ---

// GL's clip space from world, y downwards, column by column.
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
    struct orl_pass_time times[ORL_BENCH_PASSES_MAX];
    double start, *ms = orl_array(job->log, job->params->frames_max, sizeof *ms);
    enum orl_result result = ms ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_point_raster_create(job->gpu, (const float (*)[3])points->position,
                                         (const uint8_t (*)[3])points->color, points->count,
                                         raster->width, raster->height, &drawer);
    orl_gpu_take_times(job->gpu, NULL, 0);
    orl_gpu_time_passes(job->gpu, true);
    start = orl_time_s();
    for (size_t i = 0; result == ORL_OK && !enough(job, raster->frames, start); i++) {
        float matrix[16];
        struct orl_view view = orl_bench_resize_view(&job->views[i % job->view_count],
                                                     raster->width, raster->height);
        clip_matrix(&view, 1e-3 * job->scene->photo_distance, 1e3 * job->scene->photo_distance,
                    matrix);
        orl_point_raster_draw(drawer, matrix);
        if (orl_gpu_take_times(job->gpu, times, ORL_BENCH_PASSES_MAX) == 0)
            result = ORL_ERR_GPU;
        else if (i >= job->view_count) // after one round to warm up
            ms[raster->frames++] = times[0].ms;
        if (orl_progress_cancelled(job->params->progress))
            result = ORL_ERR_CANCELLED;
    }
    orl_gpu_time_passes(job->gpu, false);
    if (result == ORL_OK)
        result = orl_gpu_finish(job->gpu);
    raster->raster_ms = orl_bench_median(ms, raster->frames);
    orl_point_raster_destroy(&drawer);
    free(ms);
    return result;
}

// --- the trace ---

enum orl_result orl_bench_trace(struct bench_job *job, struct orl_renderer *renderer,
                                const struct orl_render_params *render)
{
    const struct orl_bench_run run = {.width = job->params->sizes[0][0],
                                      .height = job->params->sizes[0][1]};
    struct bench_frame_span frames[TRACE_FRAMES];
    struct orl_pass_trace trace = {.capacity = TRACE_SPANS};
    double unused;
    trace.spans = orl_array(job->log, TRACE_SPANS, sizeof *trace.spans);
    if (!trace.spans)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    orl_gpu_time_passes(job->gpu, true);
    orl_gpu_trace_passes(job->gpu, &trace);
    for (size_t i = 0; result == ORL_OK && i < TRACE_FRAMES; i++) {
        frames[i].start_s = orl_time_s();
        result = draw(job, renderer, render, &run, i, &unused);
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
