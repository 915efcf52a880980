// Measures the benchmark's configurations one after another.
#include "eval/bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "eval/bench_internal.h"
#include "eval/metrics.h"
#include "io/picture.h"
#include "scene/info.h"

// --- one configuration ---

static enum orl_result add_run(struct bench_job *job, const struct orl_bench_run *run)
{
    struct orl_bench *bench = job->bench;
    enum orl_result result = orl_grow(job->log, (void **)&bench->runs, &bench->run_capacity,
                                      bench->run_count + 1, sizeof *bench->runs);
    if (result == ORL_OK)
        bench->runs[bench->run_count++] = *run;
    return result;
}

static void step(struct bench_job *job, const char *what)
{
    orl_progress_report(job->params->progress, "bench", job->done++, job->total, what);
}

static struct orl_bench_run new_run(const struct bench_job *job, enum orl_bench_kind kind,
                                    size_t method, const int size[2])
{
    return (struct orl_bench_run){.kind = kind, .method = job->params->choices[method].method->name,
                                  .width = size[0], .height = size[1],
                                  .photographs = job->bench->photographs,
                                  .points = job->scene->points.count, .photo_divide = 1};
}

static struct orl_renderer_params new_params(const struct bench_job *job)
{
    return (struct orl_renderer_params){.max_vram_bytes = job->params->max_vram_bytes,
                                        .textures = job->params->textures};
}

// Measures all methods with one renderer.
static enum orl_result measure_methods(struct bench_job *job, struct orl_renderer *renderer,
                                       const struct orl_bench_run *like, const char *what)
{
    enum orl_result result = ORL_OK;
    for (size_t m = 0; result == ORL_OK && m < job->params->choice_count; m++) {
        struct orl_bench_run run = *like;
        run.method = job->params->choices[m].method->name;
        run.psnr_db = m == 0 ? like->psnr_db : 0;
        step(job, what);
        result = orl_bench_measure(job, renderer, &job->params->choices[m].params, &run);
        ORL_THEN(result, add_run(job, &run));
    }
    return result;
}

// The same with a renderer of these parameters.
static enum orl_result measure_with(struct bench_job *job, const struct orl_renderer_params *params,
                                    const struct orl_bench_run *like, const char *what)
{
    struct orl_renderer *renderer = NULL;
    enum orl_result result = orl_renderer_create(job->gpu, job->scene, params, &renderer);
    ORL_THEN(result, measure_methods(job, renderer, like, what));
    orl_renderer_destroy(&renderer);
    return result;
}

static enum orl_result measure_sizes(struct bench_job *job)
{
    struct orl_renderer *renderer = NULL;
    const struct orl_renderer_params params = new_params(job);
    enum orl_result result = orl_renderer_create(job->gpu, job->scene, &params, &renderer);
    for (size_t i = 0; result == ORL_OK && i < job->params->size_count; i++) {
        char what[48];
        snprintf(what, sizeof what, "%dx%d", job->params->sizes[i][0], job->params->sizes[i][1]);
        struct orl_bench_run like = new_run(job, ORL_BENCH_SIZES, 0, job->params->sizes[i]);
        result = measure_methods(job, renderer, &like, what);
        if (result == ORL_OK && i == 0)
            job->bench->memory_count =
                orl_gpu_memory(job->gpu, job->bench->memory, ORL_BENCH_MEMORY_MAX);
    }
    if (job->bench->memory_count > ORL_BENCH_MEMORY_MAX)
        job->bench->memory_count = ORL_BENCH_MEMORY_MAX;
    if (result == ORL_OK && job->params->trace)
        result = orl_bench_trace(job, renderer, &job->params->choices[0].params);
    orl_renderer_destroy(&renderer);
    return result;
}

// --- growth ---

static enum orl_result measure_photographs(struct bench_job *job)
{
    size_t all = job->bench->photographs;
    bool *use = orl_array(job->log, job->scene->photo_count, sizeof *use);
    enum orl_result result = use ? ORL_OK : ORL_ERR_MEMORY;
    size_t least = all > 1 && orl_scene_silhouettes(job->scene) ? 2 : 1; // a hull needs two
    for (size_t count = least; result == ORL_OK; count = 2 * count < all ? 2 * count : all) {
        char what[48];
        snprintf(what, sizeof what, "%zu photographs", count);
        orl_bench_choose_photos(job->scene, count, use);
        struct orl_renderer_params params = new_params(job);
        params.use = use;
        struct orl_bench_run like =
            new_run(job, ORL_BENCH_PHOTOGRAPHS, 0, job->params->sizes[0]);
        like.photographs = count;
        result = measure_with(job, &params, &like, what);
        if (count == all)
            break;
    }
    free(use);
    return result;
}

static enum orl_result add_raster(struct bench_job *job, const struct orl_points *points,
                                  double splat_ms)
{
    struct orl_bench *bench = job->bench;
    struct orl_bench_raster raster = {.points = points->count, .splat_ms = splat_ms,
                                      .width = job->params->sizes[0][0],
                                      .height = job->params->sizes[0][1]};
    step(job, "GL_POINTS");
    enum orl_result result = orl_bench_measure_raster(job, points, &raster);
    if (result == ORL_OK)
        result = orl_grow(job->log, (void **)&bench->rasters, &bench->raster_capacity,
                          bench->raster_count + 1, sizeof *bench->rasters);
    if (result == ORL_OK)
        bench->rasters[bench->raster_count++] = raster;
    return result;
}

// Time of all splatting passes of a frame.
static double splat_ms(const struct orl_bench_run *run)
{
    double sum = 0;
    for (size_t i = 0; i < run->timing.pass_count; i++)
        if (strncmp(run->timing.passes[i].name, "splat", 5) == 0)
            sum += run->timing.passes[i].ms;
    return sum;
}

static enum orl_result measure_point_count(struct bench_job *job, size_t count)
{
    struct orl_scene scene = *job->scene, *whole = job->scene;
    scene.lod = NULL; // its points take the place of all points
    const struct orl_renderer_params params = new_params(job);
    char what[48];
    snprintf(what, sizeof what, "%zu points", count);
    enum orl_result result =
        orl_bench_resample(job->log, &job->scene->points, count, &scene.points);
    if (result != ORL_OK)
        return result;
    struct orl_bench_run like = new_run(job, ORL_BENCH_POINTS, 0, job->params->sizes[0]);
    like.points = count;
    job->scene = &scene;
    result = measure_with(job, &params, &like, what);
    job->scene = whole;
    if (result == ORL_OK) {
        // Uses the first method's time: all methods have the same splatting passes.
        const struct orl_bench *bench = job->bench;
        result = add_raster(job, &scene.points,
                            splat_ms(&bench->runs[bench->run_count - job->params->choice_count]));
    }
    orl_points_finish(&scene.points);
    return result;
}

static enum orl_result measure_points(struct bench_job *job)
{
    size_t all = job->scene->points.count;
    size_t usual[] = {all / 8, all / 4, all / 2, all, 1000000, 0}, previous = 0;
    qsort(usual, ORL_COUNT(usual) - 1, sizeof *usual, orl_order_sizes);
    const size_t *counts = job->params->point_counts ? job->params->point_counts : usual;
    enum orl_result result = ORL_OK;
    if (counts == usual) // the first counts of a tiny scene may be 0
        while (*counts == 0)
            counts++;
    for (; result == ORL_OK && *counts; counts++) {
        if (*counts != previous)
            result = measure_point_count(job, *counts);
        previous = *counts;
    }
    return result;
}

// --- resolution of the photographs ---

// Renders the first view and writes its picture to image_dir. *psnr_db: its PSNR against `best`,
// which the first call sets.
static enum orl_result compare_resolution(struct bench_job *job, struct orl_renderer *renderer,
                                          int divide, struct orl_image *best, double *psnr_db)
{
    struct orl_frame frame = {0};
    struct orl_image picture = {0};
    struct orl_metrics metrics = {0};
    struct orl_view view = orl_bench_resize_view(&job->views[0], job->params->sizes[0][0],
                                                 job->params->sizes[0][1]);
    char *path = NULL;
    enum orl_result result =
        orl_renderer_draw(renderer, &view, &job->params->choices[0].params, NULL, &frame);
    ORL_THEN(result, orl_tone_srgb(job->log, &frame.color, &picture));
    if (result == ORL_OK && best->u8)
        result = orl_metrics_compare(job->log, &picture, best, &frame.coverage, &metrics);
    *psnr_db = metrics.psnr_db;
    if (result == ORL_OK && job->params->image_dir) {
        path = orl_format(job->log, "%s/photographs_1of%d.png", job->params->image_dir, divide);
        result = path ? orl_png_write(job->log, path, &picture) : ORL_ERR_MEMORY;
    }
    if (result == ORL_OK && !best->u8) {
        *best = picture;
        memset(&picture, 0, sizeof picture);
    }
    free(path);
    orl_image_finish(&picture);
    orl_frame_finish(&frame);
    return result;
}

static enum orl_result measure_resolutions(struct bench_job *job)
{
    struct orl_image best = {0};
    enum orl_result result = ORL_OK;
    for (int divide = 1; result == ORL_OK && divide <= 8; divide *= 2) {
        struct orl_renderer *renderer = NULL;
        struct orl_renderer_params params = new_params(job);
        params.photo_divide = divide;
        struct orl_bench_run like = new_run(job, ORL_BENCH_RESOLUTION, 0, job->params->sizes[0]);
        char what[48];
        snprintf(what, sizeof what, "photographs at 1/%d", divide);
        like.photo_divide = divide;
        result = orl_renderer_create(job->gpu, job->scene, &params, &renderer);
        ORL_THEN(result, compare_resolution(job, renderer, divide, &best, &like.psnr_db));
        ORL_THEN(result, measure_methods(job, renderer, &like, what));
        orl_renderer_destroy(&renderer);
    }
    orl_image_finish(&best);
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
    for (size_t i = 0; i < job->scene->photo_count; i++) {
        const struct orl_photo *photo = &job->scene->photos[i];
        if (photo->test)
            continue;
        bench->photographs++;
        if (photo->view.camera.width > bench->photo_width)
            bench->photo_width = photo->view.camera.width;
        if (photo->view.camera.height > bench->photo_height)
            bench->photo_height = photo->view.camera.height;
    }
}

static double count_steps(const struct bench_job *job)
{
    double methods = (double)job->params->choice_count;
    double steps = methods * (double)job->params->size_count;
    if (!job->params->growth)
        return steps;
    size_t points = job->params->point_counts ? 0 : 5;
    while (job->params->point_counts && job->params->point_counts[points])
        points++;
    double photographs = ceil(log2((double)job->bench->photographs)) + 1;
    return steps + methods * (photographs + 4) + (methods + 1) * (double)points;
}

enum orl_result orl_bench_run(struct orl_gpu *gpu, struct orl_scene *scene,
                              const struct orl_bench_params *params, struct orl_bench *bench)
{
    struct bench_job job = {.log = orl_gpu_log(gpu), .gpu = gpu, .scene = scene,
                            .params = params, .bench = bench};
    ORL_REQUIRE(job.log, params->size_count > 0 && params->choice_count > 0);
    ORL_REQUIRE(job.log, params->frames_max >= ORL_TIMING_FRAMES_MIN);
    memset(bench, 0, sizeof *bench);
    bench->scene = scene;
    describe(&job);
    if (!bench->photographs)
        return orl_fail(job.log, ORL_ERR_DATA, "%s: all photographs are held out", scene->dir);
    orl_bench_choose_views(&job);
    job.total = count_steps(&job);
    enum orl_result result = ORL_OK;
    if (params->image_dir)
        result = orl_dir_make(job.log, params->image_dir);
    ORL_THEN(result, measure_sizes(&job));
    if (result == ORL_OK && params->growth)
        result = measure_photographs(&job);
    if (result == ORL_OK && params->growth && scene->points.count)
        result = measure_points(&job);
    if (result == ORL_OK && params->growth)
        result = measure_resolutions(&job);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    bench->host_peak_bytes = (size_t)usage.ru_maxrss << 10;
    if (result != ORL_OK)
        orl_bench_finish(bench);
    else
        orl_progress_report(params->progress, "bench", job.total, job.total, NULL);
    return result;
}

void orl_bench_finish(struct orl_bench *bench)
{
    if (!bench)
        return;
    free(bench->runs);
    free(bench->rasters);
    memset(bench, 0, sizeof *bench);
}
