// Lists the benchmark's configurations, and measures them one after another.
#include "eval/bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "core/arguments.h"
#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/order.h"
#include "eval/bench_internal.h"
#include "eval/heldout.h"
#include "io/picture.h"
#include "scene/info.h"

enum { DIVIDE_MAX = 8 }; // of the photographs' size

const char *const orl_bench_kind_names[ORL_BENCH_KIND_COUNT] = {
    [ORL_BENCH_SIZES] = "picture", [ORL_BENCH_PHOTOGRAPHS] = "photographs",
    [ORL_BENCH_POINTS] = "points", [ORL_BENCH_RESOLUTION] = "photographs' size"};

void orl_bench_run_print(const struct orl_bench_run *run, char text[32])
{
    if (run->kind == ORL_BENCH_SIZES)
        snprintf(text, 32, "%dx%d", run->size.width, run->size.height);
    else if (run->kind == ORL_BENCH_RESOLUTION)
        snprintf(text, 32, "1/%d", run->photo_divide);
    else
        snprintf(text, 32, "%zu", run->kind == ORL_BENCH_POINTS ? run->points : run->photographs);
}

// --- the list ---

// Adds the configuration once for each method.
static enum orl_result add_runs(struct bench_job *job, struct orl_bench_run run)
{
    struct orl_bench *bench = job->bench;
    for (size_t m = 0; m < job->params->choices->count; m++) {
        ORL_TRY(ORL_GROW(job->log, bench->runs, bench->run_capacity, bench->run_count));
        run.method = job->params->choices->items[m].method->name;
        bench->runs[bench->run_count++] = run;
    }
    return ORL_OK;
}

static enum orl_result list_sizes(struct bench_job *job, struct orl_bench_run run)
{
    static const char *const usual[] = {"512x512", "1024x1024"};
    const struct orl_names *asked = &job->params->sizes;
    size_t count = asked->count ? asked->count : ORL_COUNT(usual);
    run.kind = ORL_BENCH_SIZES;
    for (size_t i = 0; i < count; i++) {
        ORL_TRY(orl_size_parse(job->log, "size", asked->count ? asked->items[i] : usual[i], &run.size));
        ORL_TRY(add_runs(job, run));
    }
    return ORL_OK;
}

static enum orl_result list_photographs(struct bench_job *job, struct orl_bench_run run)
{
    size_t all = run.photographs;
    bool hull = all > 1 && orl_scene_silhouettes(job->bench->scene); // needs two
    run.kind = ORL_BENCH_PHOTOGRAPHS;
    for (run.photographs = hull ? 2 : 1; run.photographs < all; run.photographs *= 2)
        ORL_TRY(add_runs(job, run));
    run.photographs = all;
    return add_runs(job, run);
}

// As many as are asked for, or parts of the scene's points and a million.
static enum orl_result list_points(struct bench_job *job, struct orl_bench_run run)
{
    const struct orl_names *asked = &job->params->points;
    size_t usual[] = {run.points / 8, run.points / 4, run.points / 2, run.points, 1000000}, last = 0;
    size_t count = run.points == 0 ? 0 : asked->count ? asked->count : ORL_COUNT(usual);
    qsort(usual, ORL_COUNT(usual), sizeof *usual, orl_order_sizes);
    run.kind = ORL_BENCH_POINTS;
    for (size_t i = 0; i < count; i++) {
        char *end = (char[]){""};
        double value = asked->count ? strtod(asked->items[i], &end) : (double)usual[i];
        if (asked->count && (*end || !(value >= 1 && value <= 1e9)))
            return orl_fail(job->log, ORL_ERR_ARGUMENT, "--points %s: must be a number from 1 to 1e9", asked->items[i]);
        run.points = (size_t)value;
        if (run.points != last)
            ORL_TRY(add_runs(job, run));
        last = run.points;
    }
    return ORL_OK;
}

static enum orl_result list_resolutions(struct bench_job *job, struct orl_bench_run run)
{
    run.kind = ORL_BENCH_RESOLUTION;
    for (run.photo_divide = 1; run.photo_divide <= DIVIDE_MAX; run.photo_divide *= 2)
        ORL_TRY(add_runs(job, run));
    return ORL_OK;
}

static enum orl_result list_runs(struct bench_job *job)
{
    struct orl_bench_run run = {.photographs = job->bench->photographs,
                                .points = job->bench->scene->points.count, .photo_divide = 1};
    ORL_TRY(list_sizes(job, run));
    run.size = job->bench->runs[0].size;
    job->size_runs = job->bench->run_count;
    if (job->params->quick)
        return ORL_OK;
    ORL_TRY(list_photographs(job, run));
    ORL_TRY(list_points(job, run));
    return list_resolutions(job, run);
}

// --- one configuration ---

// Renders the first view, writes its picture to image_dir and compares it with that of full-size
// photographs, which comes first.
static enum orl_result compare_resolution(struct bench_job *job, struct orl_renderer *renderer,
                                          struct orl_bench_run *run)
{
    struct orl_frame frame = {0};
    struct orl_image picture = {0};
    struct orl_metrics metrics = {0};
    struct orl_view view = orl_bench_view(job, 0, run->size);
    enum orl_result result =
        orl_renderer_draw(renderer, &view, &job->params->choices->items[0].params, NULL, &frame);
    ORL_THEN(result, orl_tone_srgb(job->log, &frame.color, &picture));
    if (result == ORL_OK && job->best.u8)
        result = orl_metrics_compare(job->log, &picture, &job->best, &frame.coverage, &metrics);
    run->psnr_db = metrics.psnr_db;
    if (result == ORL_OK && job->params->images)
        result = orl_png_write(job->log, ORL_PATH(job->params->images, "photographs_1of%d.png", run->photo_divide),
                               &picture);
    if (result == ORL_OK && !job->best.u8) {
        job->best = picture;
        memset(&picture, 0, sizeof picture);
    }
    orl_image_finish(&picture);
    orl_frame_finish(&frame);
    return result;
}

// Measures the `index`-th run. What the first one leaves on the device is its memory.
static enum orl_result measure_run(struct bench_job *job, struct orl_renderer *renderer,
                                   size_t index)
{
    struct orl_bench *bench = job->bench;
    const struct orl_choices *choices = job->params->choices;
    struct orl_bench_run *run = &bench->runs[index];
    char varied[32], what[64];
    orl_bench_run_print(run, varied);
    snprintf(what, sizeof what, "%s %s", orl_bench_kind_names[run->kind], varied);
    orl_progress_report(job->params->progress, "bench", (double)index, (double)bench->run_count,
                        what);
    ORL_TRY(orl_bench_measure(job, renderer, &choices->items[index % choices->count].params, run));
    if (index > 0)
        return ORL_OK;
    bench->memory_count = orl_gpu_memory(job->gpu, bench->memory, ORL_BENCH_MEMORY_MAX);
    if (bench->memory_count > ORL_BENCH_MEMORY_MAX)
        bench->memory_count = ORL_BENCH_MEMORY_MAX;
    return ORL_OK;
}

// Measures runs [first, end), which differ in picture and method alone, with one renderer.
static enum orl_result measure_runs(struct bench_job *job, size_t first, size_t end)
{
    struct orl_bench_run *run = &job->bench->runs[first];
    struct orl_scene scene = *job->bench->scene;
    struct orl_points points = {0};
    struct orl_renderer *renderer = NULL;
    bool *use = orl_array(job->log, scene.photo_count, sizeof *use);
    struct orl_renderer_params params = {.use = use, .max_vram_bytes = job->params->max_vram_bytes,
                                         .textures = job->params->textures,
                                         .photo_divide = run->photo_divide};
    enum orl_result result = use ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < scene.photo_count; i++)
        use[i] = orl_heldout_chosen(&scene, false, run->photographs, i);
    if (result == ORL_OK && run->kind == ORL_BENCH_POINTS) {
        result = orl_bench_resample(job->log, &job->bench->scene->points, run->points, &points);
        scene.points = points;
        scene.lod = NULL; // the points take the place of all its points
    }
    job->scene = &scene;
    ORL_THEN(result, orl_renderer_create(job->gpu, &scene, &params, &renderer));
    if (result == ORL_OK && run->kind == ORL_BENCH_RESOLUTION)
        result = compare_resolution(job, renderer, run);
    for (size_t i = first; result == ORL_OK && i < end; i++)
        result = measure_run(job, renderer, i);
    if (result == ORL_OK && first == 0 && job->params->trace)
        result = orl_bench_trace(job, renderer, &job->params->choices->items[0].params, run);
    orl_renderer_destroy(&renderer);
    job->scene = NULL;
    orl_points_finish(&points);
    free(use);
    return result;
}

// --- all ---

static void describe(struct bench_job *job)
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

enum orl_result orl_bench_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                              const struct orl_bench_params *params, struct orl_bench *bench)
{
    struct bench_job job = {.log = orl_gpu_log(gpu), .gpu = gpu, .params = params, .bench = bench};
    ORL_REQUIRE(job.log, params->choices->count > 0);
    memset(bench, 0, sizeof *bench);
    bench->scene = scene;
    describe(&job);
    if (!bench->photographs)
        return orl_fail(job.log, ORL_ERR_DATA, "%s: all photographs are held out", scene->dir);
    orl_bench_choose_views(&job);
    enum orl_result result = list_runs(&job);
    if (result == ORL_OK && params->images)
        result = orl_dir_make(job.log, params->images);
    // The sizes come first, and share a renderer.
    for (size_t first = 0, end; result == ORL_OK && first < bench->run_count; first = end) {
        end = first == 0 ? job.size_runs : first + params->choices->count;
        result = measure_runs(&job, first, end);
    }
    orl_image_finish(&job.best);
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

static json_t *run_json(const struct orl_bench_run *run)
{
    json_t *object = json_pack(
        "{s:s, s:[i,i], s:I, s:I, s:i, s:I, s:f, s:f, s:f, s:f, s:I, s:I, s:o}", "method", run->method,
        "size", run->size.width, run->size.height, "photographs", (json_int_t)run->photographs, "points",
        (json_int_t)run->points, "photo_divide", run->photo_divide, "frames",
        (json_int_t)run->timing.frames, "frame_ms", run->timing.median_ms, "slowest_ms",
        run->timing.slowest_ms, "cpu_ms", run->timing.cpu_ms, "fps",
        run->timing.median_ms > 0 ? 1e3 / run->timing.median_ms : 0.0, "device_bytes",
        (json_int_t)run->device_bytes, "uploaded_bytes", (json_int_t)run->uploaded_bytes,
        "passes_ms", passes_json(run));
    if (run->psnr_db > 0)
        json_object_set_new(object, "psnr_db", json_real(run->psnr_db));
    return object;
}

static json_t *runs_json(const struct orl_bench *bench, enum orl_bench_kind kind)
{
    json_t *array = json_array();
    for (size_t i = 0; i < bench->run_count; i++)
        if (bench->runs[i].kind == kind)
            json_array_append_new(array, run_json(&bench->runs[i]));
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
        "{s:o, s:s, s:s, s:b, s:I, s:I, s:I, s:[i,i], s:I, s:o, s:o, s:o, s:o, s:o}", "scene",
        orl_json_string(bench->scene->dir), "device", bench->device, "driver", bench->driver, "software",
        bench->software, "points", (json_int_t)orl_scene_point_count(bench->scene),
        "time_steps", (json_int_t)bench->scene->frame_count, "photographs", (json_int_t)bench->photographs,
        "photo_size", bench->photo_width, bench->photo_height,
        "host_peak_bytes", (json_int_t)bench->host_peak_bytes, "memory", memory_json(bench),
        "sizes", runs_json(bench, ORL_BENCH_SIZES), "by_photographs",
        runs_json(bench, ORL_BENCH_PHOTOGRAPHS), "by_points", runs_json(bench, ORL_BENCH_POINTS),
        "by_resolution", runs_json(bench, ORL_BENCH_RESOLUTION));
}
