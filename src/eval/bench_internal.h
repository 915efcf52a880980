// Private to the benchmark: what bench_measure.c does for bench.c.
#ifndef ORL_EVAL_BENCH_INTERNAL_H
#define ORL_EVAL_BENCH_INTERNAL_H

#include "eval/bench.h"

enum { BENCH_VIEWS = 3 };

struct bench_job {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    struct orl_scene *scene; // the run's: with its points, and at the time step that is shown
    const struct orl_bench_params *params;
    struct orl_bench *bench;
    size_t size_runs; // the first ones, which differ in the picture's size and the method alone
    struct orl_view views[BENCH_VIEWS]; // with the photographs' cameras
    struct orl_image best; // owned: the picture of full-size photographs
};

// Chooses views between neighbouring photographs, spread over the scene.
void orl_bench_choose_views(struct bench_job *job);
// The view of frame `number`, of this size.
struct orl_view orl_bench_view(const struct bench_job *job, size_t number, struct orl_size size);
// Makes `count` points: an even choice of `all` with larger radii, or each point split into several
// smaller ones on its disc. The caller owns the result.
enum orl_result orl_bench_resample(const struct orl_log *log, const struct orl_points *all,
                                   size_t count, struct orl_points *points);

// Fills times and bytes of `run`, whose configuration is set, by drawing with `renderer`.
enum orl_result orl_bench_measure(struct bench_job *job, struct orl_renderer *renderer,
                                  const struct orl_render_params *render,
                                  struct orl_bench_run *run);
// Draws some frames as those of `run` and writes the trace to job->params->trace.
enum orl_result orl_bench_trace(struct bench_job *job, struct orl_renderer *renderer,
                                const struct orl_render_params *render,
                                const struct orl_bench_run *run);

#endif
