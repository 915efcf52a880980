// Measures one configuration: its views and points, median times and memory, and a trace of a few
// frames.
#include <jansson.h>
#include <math.h>
#include <stdlib.h>

#include "core/json.h"
#include "core/memory.h"
#include "core/process.h"
#include "core/vec3.h"
#include "eval/bench_internal.h"
#include "oriel/path.h"

enum { WARM_UP = 2, TRACE_FRAMES = 6, TRACE_SPANS = 1024 };

// --- views and points ---

static size_t next_used(const struct orl_scene *scene, size_t from)
{
    while (from < scene->photo_count && scene->photos[from].test)
        from++;
    return from;
}

void orl_bench_choose_views(struct bench_job *job)
{
    const struct orl_scene *scene = job->bench->scene;
    for (size_t k = 0; k < BENCH_VIEWS; k++) {
        size_t a = next_used(scene, (2 * k + 1) * scene->photo_count / (2 * BENCH_VIEWS));
        size_t b = a < scene->photo_count ? next_used(scene, a + 1) : a;
        if (a == scene->photo_count)
            a = next_used(scene, 0);
        if (b == scene->photo_count)
            b = next_used(scene, 0);
        job->views[k] =
            orl_view_interpolate(&scene->photos[a].view, &scene->photos[b].view, 0.5);
    }
}

struct orl_view orl_bench_view(const struct bench_job *job, size_t number, struct orl_size size)
{
    struct orl_view view = job->views[number % BENCH_VIEWS];
    view.camera = orl_camera_reframed(&view.camera, size.width, size.height);
    return view;
}

// Moves a copy of a point on the point's disc, which its copies fill evenly (Vogel's spiral).
static void spread(struct orl_points *points, size_t i, size_t copy, size_t copies, float radius)
{
    const float *normal = points->normal[i];
    const double n[3] = {(double)normal[0], (double)normal[1], (double)normal[2]};
    const double axis[3] = {fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0};
    double u[3], v[3], angle = 2.3999632 * (double)copy;
    double far = 0.5 * (double)radius * sqrt(((double)copy + 0.5) / (double)copies);
    orl_cross3(n, axis, u);
    orl_normalize3(u);
    orl_cross3(n, u, v);
    for (int k = 0; k < 3; k++)
        points->position[i][k] += (float)(far * (cos(angle) * u[k] + sin(angle) * v[k]));
}

enum orl_result orl_bench_resample(const struct orl_log *log, const struct orl_points *all,
                                   size_t count, struct orl_points *points)
{
    ORL_TRY(orl_points_init(log, points, count));
    // The total area stays the same: fewer points are larger.
    float scale = sqrtf((float)all->count / (float)count);
    for (size_t i = 0; i < count; i++) {
        size_t from = (size_t)((double)i * (double)all->count / (double)count);
        from = from < all->count ? from : all->count - 1;
        orl_points_copy(all, from, points, i);
        if (count > all->count) {
            size_t first = (size_t)ceil((double)from * (double)count / (double)all->count);
            spread(points, i, i - first, count / all->count + 1, all->radius[from]);
        }
        points->radius[i] *= scale;
    }
    return ORL_OK;
}

// --- medians ---

// The frames of one run.
struct run_frames {
    struct bench_job *job;
    struct orl_renderer *renderer;
    const struct orl_render_params *render;
    struct orl_size size;
};

static enum orl_result draw(void *priv, size_t number)
{
    const struct run_frames *f = priv;
    struct orl_view view = orl_bench_view(f->job, number, f->size);
    ORL_TRY(orl_timing_show_time_step(f->job->gpu, f->job->scene, f->renderer, number));
    return orl_renderer_draw(f->renderer, &view, f->render, NULL, NULL);
}

enum orl_result orl_bench_measure(struct bench_job *job, struct orl_renderer *renderer,
                                  const struct orl_render_params *render,
                                  struct orl_bench_run *run)
{
    struct run_frames frames = {job, renderer, render, run->size};
    const struct orl_timing_params params = {
        .draw = draw, .priv = &frames, .views = BENCH_VIEWS, .warm_up = WARM_UP,
        .seconds = job->params->seconds, .frames_max = (size_t)job->params->frames,
        .pass_frames = (size_t)job->params->frames, .progress = job->params->progress};
    enum orl_result result = orl_timing_take(job->gpu, &params, &run->timing);
    if (result == ORL_OK && job->scene->frame_count)
        result = orl_scene_set_frame(job->log, job->scene, -1);
    run->device_bytes = orl_gpu_bytes(job->gpu);
    run->uploaded_bytes = orl_renderer_uploaded(renderer);
    return result;
}

// --- the trace ---

// In the format of Chrome and Perfetto: complete events ("X") in microseconds, with one thread for the CPU
// and one for the device.
enum { THREAD_FRAMES = 1, THREAD_CPU, THREAD_DEVICE };

static json_t *span(const char *name, int thread, double start_s, double end_s, double origin_s)
{
    return json_pack("{s:s, s:s, s:i, s:i, s:f, s:f}", "name", name, "ph", "X", "pid", 1, "tid",
                     thread, "ts", 1e6 * (start_s - origin_s), "dur", 1e6 * (end_s - start_s));
}

static json_t *thread_name(int thread, const char *name)
{
    return json_pack("{s:s, s:s, s:i, s:i, s:{s:s}}", "name", "thread_name", "ph", "M", "pid", 1,
                     "tid", thread, "args", "name", name);
}

static enum orl_result write_trace(const struct bench_job *job, const struct orl_pass_trace *trace,
                                   double frames[TRACE_FRAMES][2])
{
    const char *path = job->params->trace;
    double origin = frames[0][0];
    json_t *events = json_array();
    json_array_append_new(events, thread_name(THREAD_FRAMES, "frames"));
    json_array_append_new(events, thread_name(THREAD_CPU, "CPU: passes asked for"));
    json_array_append_new(events, thread_name(THREAD_DEVICE, job->bench->device));
    for (size_t i = 0; i < TRACE_FRAMES; i++)
        json_array_append_new(events, span("frame", THREAD_FRAMES, frames[i][0], frames[i][1], origin));
    for (size_t i = 0; i < trace->count; i++) {
        const struct orl_pass_span *s = &trace->spans[i];
        json_array_append_new(events,
                              span(s->name, THREAD_CPU, s->cpu_start_s, s->cpu_end_s, origin));
        json_array_append_new(events,
                              span(s->name, THREAD_DEVICE, s->gpu_start_s, s->gpu_end_s, origin));
    }
    if (trace->dropped)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: %zu passes left out", path, trace->dropped);
    json_t *root = json_pack("{s:s, s:o}", "displayTimeUnit", "ms", "traceEvents", events);
    enum orl_result result = orl_json_write(job->log, path, root);
    json_decref(root);
    return result;
}

enum orl_result orl_bench_trace(struct bench_job *job, struct orl_renderer *renderer,
                                const struct orl_render_params *render,
                                const struct orl_bench_run *run)
{
    struct run_frames traced = {job, renderer, render, run->size};
    double frames[TRACE_FRAMES][2]; // start and end
    struct orl_pass_trace trace = {.capacity = TRACE_SPANS};
    trace.spans = orl_array(job->log, TRACE_SPANS, sizeof *trace.spans);
    ORL_TRY_MEMORY(trace.spans);
    enum orl_result result = ORL_OK;
    orl_gpu_time_passes(job->gpu, true);
    orl_gpu_trace_passes(job->gpu, &trace);
    for (size_t i = 0; result == ORL_OK && i < TRACE_FRAMES; i++) {
        frames[i][0] = orl_time_s();
        result = orl_progress_cancelled(job->params->progress) ? ORL_ERR_CANCELLED
                                                               : draw(&traced, i);
        frames[i][1] = orl_time_s();
    }
    orl_gpu_trace_passes(job->gpu, NULL);
    orl_gpu_time_passes(job->gpu, false);
    orl_gpu_take_times(job->gpu, NULL, 0);
    ORL_THEN(result, write_trace(job, &trace, frames));
    free(trace.spans);
    return result;
}
