// Lists the benchmark's configurations, and measures them one after another.
#include "eval/bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "eval/bench_internal.h"
#include "eval/heldout.h"
#include "io/picture.h"
#include "scene/info.h"

enum { DOUBLINGS = 8 * sizeof(size_t), RESOLUTIONS = 4 };

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

double orl_bench_splat_ms(const struct orl_bench_run *run)
{
    double sum = 0;
    for (size_t i = 0; i < run->timing.pass_count; i++)
        if (strncmp(run->timing.passes[i].name, "splat", 5) == 0)
            sum += run->timing.passes[i].ms;
    return sum;
}

// --- the list ---

// Adds the configuration once for each method.
static void add_runs(struct bench_job *job, struct orl_bench_run run)
{
    for (size_t m = 0; m < job->params->choice_count; m++) {
        run.method = job->params->choices[m].method->name;
        job->bench->runs[job->bench->run_count++] = run;
    }
}

static void list_growth(struct bench_job *job, struct orl_bench_run run, const size_t *points,
                        size_t points_count)
{
    size_t photographs = run.photographs, all = run.points;
    bool hull = photographs > 1 && orl_scene_silhouettes(job->bench->scene); // needs two
    run.kind = ORL_BENCH_PHOTOGRAPHS;
    for (run.photographs = hull ? 2 : 1; run.photographs < photographs; run.photographs *= 2)
        add_runs(job, run);
    run.photographs = photographs;
    add_runs(job, run);
    run.kind = ORL_BENCH_POINTS;
    for (size_t i = 0; all && i < points_count; i++) {
        run.points = points[i];
        if (points[i] && (i == 0 || points[i] != points[i - 1]))
            add_runs(job, run);
    }
    run.points = all;
    run.kind = ORL_BENCH_RESOLUTION;
    for (int i = 0; i < RESOLUTIONS; i++, run.photo_divide *= 2)
        add_runs(job, run);
}

static enum orl_result list_runs(struct bench_job *job)
{
    const struct orl_bench_params *params = job->params;
    struct orl_bench_run run = {.photographs = job->bench->photographs,
                                .points = job->bench->scene->points.count, .photo_divide = 1};
    size_t usual[] = {run.points / 8, run.points / 4, run.points / 2, run.points, 1000000};
    qsort(usual, ORL_COUNT(usual), sizeof *usual, orl_order_sizes);
    const size_t *points = params->points ? params->points : usual;
    size_t points_count = params->points ? params->points_count : ORL_COUNT(usual);
    size_t most = params->size_count + DOUBLINGS + points_count + RESOLUTIONS;
    job->bench->runs = orl_array(job->log, params->choice_count * most, sizeof *job->bench->runs);
    ORL_TRY_MEMORY(job->bench->runs);
    for (size_t i = 0; i < params->size_count; i++) {
        run.size = params->sizes[i];
        add_runs(job, run);
    }
    run.size = params->sizes[0];
    if (params->growth)
        list_growth(job, run, points, points_count);
    return ORL_OK;
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
        orl_renderer_draw(renderer, &view, &job->params->choices[0].params, NULL, &frame);
    ORL_THEN(result, orl_tone_srgb(job->log, &frame.color, &picture));
    if (result == ORL_OK && job->best.u8)
        result = orl_metrics_compare(job->log, &picture, &job->best, &frame.coverage, &metrics);
    run->psnr_db = metrics.psnr_db;
    if (result == ORL_OK && job->params->image_dir)
        result = orl_png_write(job->log, ORL_PATH(job->params->image_dir, "photographs_1of%d.png", run->photo_divide),
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
    const struct orl_choice *choices = job->params->choices;
    struct orl_bench_run *run = &bench->runs[index];
    char varied[32], what[64];
    orl_bench_run_print(run, varied);
    snprintf(what, sizeof what, "%s %s", orl_bench_kind_names[run->kind], varied);
    orl_progress_report(job->params->progress, "bench", (double)index, (double)bench->run_count,
                        what);
    ORL_TRY(orl_bench_measure(job, renderer, &choices[index % job->params->choice_count].params, run));
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
        result = orl_bench_trace(job, renderer, &job->params->choices[0].params, run);
    orl_renderer_destroy(&renderer);
    if (result == ORL_OK && run->kind == ORL_BENCH_POINTS)
        result = orl_bench_measure_raster(job, run);
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
    ORL_REQUIRE(job.log, params->size_count > 0 && params->choice_count > 0);
    ORL_REQUIRE(job.log, params->frames_max >= ORL_TIMING_FRAMES_MIN);
    memset(bench, 0, sizeof *bench);
    bench->scene = scene;
    describe(&job);
    if (!bench->photographs)
        return orl_fail(job.log, ORL_ERR_DATA, "%s: all photographs are held out", scene->dir);
    orl_bench_choose_views(&job);
    enum orl_result result = list_runs(&job);
    if (result == ORL_OK && params->image_dir)
        result = orl_dir_make(job.log, params->image_dir);
    // The sizes come first, and share a renderer.
    for (size_t first = 0, end; result == ORL_OK && first < bench->run_count; first = end) {
        end = first + params->choice_count * (first == 0 ? params->size_count : 1);
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
