// Private to the benchmark: its parts in bench_*.c.
#ifndef ORL_EVAL_BENCH_INTERNAL_H
#define ORL_EVAL_BENCH_INTERNAL_H

#include "eval/bench.h"

enum { BENCH_VIEWS_MAX = 3 };

struct bench_job {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    struct orl_scene *scene;
    const struct orl_bench_params *params;
    struct orl_bench *bench;
    struct orl_view views[BENCH_VIEWS_MAX]; // of the photographs' size; resized for each run
    size_t view_count;
    double done, total; // configurations, for the progress report
};

// --- bench_scene.c: the scene with more or fewer points and photographs ---

// Chooses views between neighbouring photographs, spread over the scene.
void orl_bench_choose_views(struct bench_job *job);
// Crops the view to the shape of width x height, as wide as fits into the photograph's.
struct orl_view orl_bench_resize_view(const struct orl_view *view, int width, int height);
// Makes `count` points: an even choice of `all` with larger radii, or each point split into several
// smaller ones on its disc. The caller owns the result.
enum orl_result orl_bench_resample(const struct orl_log *log, const struct orl_points *all,
                                   size_t count, struct orl_points *points);
// Sets use[i] for an even choice of `count` photographs that are not held out.
void orl_bench_choose_photos(const struct orl_scene *scene, size_t count, bool *use);

// --- bench_measure.c: medians ---

// Fills times and bytes of `run`, whose configuration is set, by drawing with `renderer`.
enum orl_result orl_bench_measure(struct bench_job *job, struct orl_renderer *renderer,
                                  const struct orl_render_params *render,
                                  struct orl_bench_run *run);
enum orl_result orl_bench_measure_raster(struct bench_job *job, const struct orl_points *points,
                                         struct orl_bench_raster *raster);
// Draws some frames and writes the trace to job->params->trace.
enum orl_result orl_bench_trace(struct bench_job *job, struct orl_renderer *renderer,
                                const struct orl_render_params *render);

// --- bench_trace.c ---

struct bench_frame_span {
    double start_s, end_s;
};
enum orl_result orl_bench_write_trace(const struct orl_log *log, const char *path,
                                      const char *device, const struct orl_pass_trace *trace,
                                      const struct bench_frame_span *frames, size_t frame_count);

#endif
