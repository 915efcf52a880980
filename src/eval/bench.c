// Measures frames of each size and method, one after another, and writes a trace of a few.
#include "eval/bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "core/arguments.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/process.h"
#include "oriel/path.h"

enum { VIEWS = 3, WARM_UP = 2, TRACE_FRAMES = 6, TRACE_SPANS = 1024 };

struct job {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    struct orl_scene scene; // at the time step that is shown
    const struct orl_bench_params *params;
    struct orl_bench *bench;
    struct orl_renderer *renderer;
    struct orl_view views[VIEWS]; // with the photographs' cameras
};

// --- views ---

static size_t next_used(const struct orl_scene *scene, size_t from)
{
    while (from < scene->photo_count && scene->photos[from].test)
        from++;
    return from;
}

// Views between neighbouring photographs, spread over the scene.
static void choose_views(struct job *job)
{
    const struct orl_scene *scene = job->bench->scene;
    for (size_t k = 0; k < VIEWS; k++) {
        size_t a = next_used(scene, (2 * k + 1) * scene->photo_count / (2 * VIEWS));
        size_t b = a < scene->photo_count ? next_used(scene, a + 1) : a;
        if (a == scene->photo_count)
            a = next_used(scene, 0);
        if (b == scene->photo_count)
            b = next_used(scene, 0);
        job->views[k] =
            orl_view_interpolate(&scene->photos[a].view, &scene->photos[b].view, 0.5);
    }
}

// --- the list ---

// Each size with each method.
static enum orl_result list_runs(struct job *job)
{
    static const char *const usual[] = {"512x512", "1024x1024"};
    struct orl_bench *bench = job->bench;
    const struct orl_names *asked = &job->params->sizes;
    size_t count = asked->count ? asked->count : ORL_COUNT(usual);
    for (size_t i = 0; i < count; i++) {
        struct orl_bench_run run = {0};
        ORL_TRY(orl_size_parse(job->log, "size", asked->count ? asked->items[i] : usual[i], &run.size));
        for (size_t m = 0; m < job->params->choices->count; m++) {
            ORL_TRY(ORL_GROW(job->log, bench->runs, bench->run_capacity, bench->run_count));
            run.method = job->params->choices->items[m].method->name;
            bench->runs[bench->run_count++] = run;
        }
    }
    return ORL_OK;
}

// --- one configuration ---

struct run_frames {
    struct job *job;
    const struct orl_render_params *render;
    struct orl_size size;
};

static enum orl_result draw(void *priv, size_t number)
{
    const struct run_frames *f = priv;
    struct job *job = f->job;
    struct orl_view view = job->views[number % VIEWS];
    view.camera = orl_camera_reframed(&view.camera, f->size.width, f->size.height);
    ORL_TRY(orl_timing_show_time_step(job->gpu, &job->scene, job->renderer, number));
    return orl_renderer_draw(job->renderer, &view, f->render, NULL, NULL);
}

static enum orl_result time_frames(struct job *job, const struct orl_render_params *render,
                                   struct orl_bench_run *run)
{
    struct run_frames frames = {job, render, run->size};
    const struct orl_timing_params params = {
        .draw = draw, .priv = &frames, .views = VIEWS, .warm_up = WARM_UP,
        .seconds = job->params->seconds, .frames_max = (size_t)job->params->frames,
        .pass_frames = (size_t)job->params->frames, .progress = job->params->progress};
    ORL_TRY(orl_timing_take(job->gpu, &params, &run->timing));
    if (job->scene.frame_count)
        ORL_TRY(orl_scene_set_frame(job->log, &job->scene, -1));
    run->device_bytes = orl_gpu_bytes(job->gpu);
    run->uploaded_bytes = orl_renderer_uploaded(job->renderer);
    return ORL_OK;
}

// Measures the `index`-th run. What the first one leaves on the device is its memory.
static enum orl_result measure_run(struct job *job, size_t index)
{
    struct orl_bench *bench = job->bench;
    const struct orl_choices *choices = job->params->choices;
    struct orl_bench_run *run = &bench->runs[index];
    char what[64];
    snprintf(what, sizeof what, "picture %dx%d", run->size.width, run->size.height);
    orl_progress_report(job->params->progress, "bench", (double)index, (double)bench->run_count,
                        what);
    ORL_TRY(time_frames(job, &choices->items[index % choices->count].params, run));
    if (index > 0)
        return ORL_OK;
    bench->memory_count = orl_gpu_memory(job->gpu, bench->memory, ORL_BENCH_MEMORY_MAX);
    if (bench->memory_count > ORL_BENCH_MEMORY_MAX)
        bench->memory_count = ORL_BENCH_MEMORY_MAX;
    return ORL_OK;
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

static enum orl_result write_trace(const struct job *job, const struct orl_pass_trace *trace,
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

// Draws some frames as those of the first run.
static enum orl_result trace_frames(struct job *job)
{
    struct run_frames traced = {job, &job->params->choices->items[0].params, job->bench->runs[0].size};
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

// --- all ---

static void describe(struct job *job)
{
    struct orl_bench *bench = job->bench;
    const struct orl_gpu_caps *caps = orl_gpu_caps(job->gpu);
    snprintf(bench->device, sizeof bench->device, "%s", caps->renderer);
    snprintf(bench->driver, sizeof bench->driver, "%s", caps->version);
    bench->software = caps->software;
    for (size_t i = 0; i < bench->scene->photo_count; i++) {
        const struct orl_photo *photo = &bench->scene->photos[i];
        if (photo->test)
            continue;
        bench->photographs++;
        if (photo->view.camera.width > bench->photo_width)
            bench->photo_width = photo->view.camera.width;
        if (photo->view.camera.height > bench->photo_height)
            bench->photo_height = photo->view.camera.height;
    }
}

static enum orl_result measure(struct job *job)
{
    const struct orl_renderer_params params = {.max_vram_bytes = job->params->max_vram_bytes,
                                               .textures = job->params->textures};
    ORL_TRY(list_runs(job));
    ORL_TRY(orl_renderer_create(job->gpu, &job->scene, &params, &job->renderer));
    for (size_t i = 0; i < job->bench->run_count; i++)
        ORL_TRY(measure_run(job, i));
    return job->params->trace ? trace_frames(job) : ORL_OK;
}

enum orl_result orl_bench_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                              const struct orl_bench_params *params, struct orl_bench *bench)
{
    struct job job = {.log = orl_gpu_log(gpu), .gpu = gpu, .scene = *scene, .params = params, .bench = bench};
    ORL_REQUIRE(job.log, params->choices->count > 0);
    memset(bench, 0, sizeof *bench);
    bench->scene = scene;
    describe(&job);
    if (!bench->photographs)
        return orl_fail(job.log, ORL_ERR_DATA, "%s: all photographs are held out", scene->dir);
    choose_views(&job);
    enum orl_result result = measure(&job);
    orl_renderer_destroy(&job.renderer);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    bench->host_peak_bytes = (size_t)usage.ru_maxrss << 10;
    if (result != ORL_OK)
        orl_bench_finish(bench);
    else
        orl_progress_report(params->progress, "bench", (double)bench->run_count,
                            (double)bench->run_count, NULL);
    return result;
}

void orl_bench_finish(struct orl_bench *bench)
{
    if (!bench)
        return;
    free(bench->runs);
    memset(bench, 0, sizeof *bench);
}

// --- the report: field names are fixed ---

static json_t *passes_json(const struct orl_bench_run *run)
{
    json_t *passes = json_object();
    for (size_t i = 0; i < run->timing.pass_count; i++) {
        const struct orl_timing_pass *pass = &run->timing.passes[i];
        json_object_set_new(passes, pass->name, json_real(pass->ms));
    }
    return passes;
}

static json_t *runs_json(const struct orl_bench *bench)
{
    json_t *array = json_array();
    for (size_t i = 0; i < bench->run_count; i++) {
        const struct orl_bench_run *run = &bench->runs[i];
        const struct orl_timing *timing = &run->timing;
        json_array_append_new(array, json_pack(
            "{s:s, s:[i,i], s:I, s:f, s:f, s:f, s:f, s:I, s:I, s:o}", "method", run->method, "size",
            run->size.width, run->size.height, "frames", (json_int_t)timing->frames, "frame_ms",
            timing->median_ms, "slowest_ms", timing->slowest_ms, "cpu_ms", timing->cpu_ms, "fps",
            timing->median_ms > 0 ? 1e3 / timing->median_ms : 0.0, "device_bytes",
            (json_int_t)run->device_bytes, "uploaded_bytes", (json_int_t)run->uploaded_bytes,
            "passes_ms", passes_json(run)));
    }
    return array;
}

static json_t *memory_json(const struct orl_bench *bench)
{
    json_t *array = json_array();
    for (size_t i = 0; i < bench->memory_count; i++)
        json_array_append_new(array, json_pack(
            "{s:s, s:s, s:I, s:I}", "owner", orl_owner_names[bench->memory[i].owner],
            "tag", bench->memory[i].tag, "bytes", (json_int_t)bench->memory[i].bytes, "objects",
            (json_int_t)bench->memory[i].objects));
    return array;
}

json_t *orl_bench_report(const struct orl_bench *bench)
{
    return json_pack(
        "{s:o, s:s, s:s, s:b, s:I, s:I, s:I, s:[i,i], s:I, s:o, s:o}", "scene",
        orl_json_string(bench->scene->dir), "device", bench->device, "driver", bench->driver, "software",
        bench->software, "points", (json_int_t)orl_scene_point_count(bench->scene),
        "time_steps", (json_int_t)bench->scene->frame_count, "photographs", (json_int_t)bench->photographs,
        "photo_size", bench->photo_width, bench->photo_height,
        "host_peak_bytes", (json_int_t)bench->host_peak_bytes, "memory", memory_json(bench),
        "sizes", runs_json(bench));
}
