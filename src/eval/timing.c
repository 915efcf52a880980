#include "eval/timing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"
#include "core/process.h"

double orl_median(double *values, size_t count)
{
    if (!count)
        return 0;
    qsort(values, count, sizeof *values, orl_order_doubles);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

// True when `frames` frames, the first begun at start_s, are enough.
static bool is_enough(const struct orl_timing_params *params, size_t frames, double start_s)
{
    return frames >= params->frames_max ||
           (frames >= ORL_TIMING_FRAMES_MIN && frames % params->views == 0 &&
            orl_time_s() - start_s >= params->seconds);
}

enum orl_result orl_timing_show_time_step(struct orl_gpu *gpu, struct orl_scene *scene,
                                          struct orl_renderer *renderer, size_t number)
{
    if (!scene->frame_count)
        return ORL_OK;
    orl_renderer_expect(renderer, (int)((number + 1) % scene->frame_count));
    return orl_scene_set_frame(orl_gpu_log(gpu), scene, (int)(number % scene->frame_count));
}

static enum orl_result draw(const struct orl_timing_params *params, size_t number, double *ms,
                            double *cpu_ms)
{
    if (orl_progress_cancelled(params->progress))
        return ORL_ERR_CANCELLED;
    double start = orl_time_s(), cpu_start = orl_cpu_time_s();
    enum orl_result result = params->draw(params->priv, number);
    *ms = 1e3 * (orl_time_s() - start);
    *cpu_ms = 1e3 * (orl_cpu_time_s() - cpu_start);
    return result;
}

static enum orl_result take_frames(const struct orl_timing_params *params, double *ms,
                                   double *cpu_ms, struct orl_timing *timing)
{
    double start = orl_time_s();
    for (; !is_enough(params, timing->frames, start); timing->frames++)
        ORL_TRY(draw(params, timing->frames, &ms[timing->frames], &cpu_ms[timing->frames]));
    timing->median_ms = orl_median(ms, timing->frames); // sorts
    timing->cpu_ms = orl_median(cpu_ms, timing->frames);
    timing->slowest_ms = ms[timing->frames - 1];
    return ORL_OK;
}

struct orl_timing_pass *orl_timing_pass(struct orl_timing_pass *passes, size_t *count,
                                        const char *name)
{
    for (size_t i = 0; i < *count; i++)
        if (strcmp(passes[i].name, name) == 0)
            return &passes[i];
    if (*count == ORL_TIMING_PASSES_MAX)
        return NULL;
    passes[*count].name = name;
    return &passes[(*count)++];
}

// Adds one frame's passes to the columns, which are `rows` long. New passes get a column.
static void note_passes(struct orl_gpu *gpu, struct orl_timing *timing, double *columns,
                        size_t rows, size_t frame)
{
    struct orl_pass_time times[ORL_TIMING_PASSES_MAX];
    size_t count = orl_gpu_take_times(gpu, times, ORL_TIMING_PASSES_MAX);
    for (size_t i = 0; i < count && i < ORL_TIMING_PASSES_MAX; i++) {
        const struct orl_timing_pass *pass =
            orl_timing_pass(timing->passes, &timing->pass_count, times[i].name);
        if (pass)
            columns[(size_t)(pass - timing->passes) * rows + frame] = times[i].ms;
    }
}

static enum orl_result take_passes(struct orl_gpu *gpu, const struct orl_timing_params *params,
                                   struct orl_timing *timing)
{
    size_t frames = params->pass_frames < timing->frames ? params->pass_frames : timing->frames;
    double unused[2], *columns =
        orl_array(orl_gpu_log(gpu), frames * ORL_TIMING_PASSES_MAX, sizeof *columns);
    ORL_TRY_MEMORY(columns);
    enum orl_result result = ORL_OK;
    orl_gpu_take_times(gpu, NULL, 0);
    orl_gpu_time_passes(gpu, true);
    for (size_t i = 0; result == ORL_OK && i < frames; i++) {
        result = draw(params, i, &unused[0], &unused[1]);
        note_passes(gpu, timing, columns, frames, i);
    }
    orl_gpu_time_passes(gpu, false);
    for (size_t k = 0; k < timing->pass_count; k++)
        timing->passes[k].ms = orl_median(&columns[k * frames], frames);
    free(columns);
    return result;
}

enum orl_result orl_timing_take(struct orl_gpu *gpu, const struct orl_timing_params *params,
                                struct orl_timing *timing)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    memset(timing, 0, sizeof *timing);
    ORL_REQUIRE(log, params->views > 0 && params->frames_max >= ORL_TIMING_FRAMES_MIN);
    double unused[2], *ms = orl_array(log, 2 * params->frames_max, sizeof *ms);
    enum orl_result result = ms ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < params->warm_up * params->views; i++)
        result = draw(params, i, &unused[0], &unused[1]);
    ORL_THEN(result, take_frames(params, ms, ms + params->frames_max, timing));
    if (result == ORL_OK && params->pass_frames)
        result = take_passes(gpu, params, timing);
    free(ms);
    return result;
}

// --- pairs ---

// Standard errors that make a difference clear.
static const double clear = 3;
// A few rounds may agree by chance: a round's standard deviation is taken to be this at least.
static const double min_deviation = 0.01;
// Of normal noise, sqrt(pi / 2): the standard error of the median divided by that of the mean.
static const double normal_noise = 1.2533;

static enum orl_result take_round(const struct orl_pair_timing_params *params, size_t round,
                                  double ms[2])
{
    bool begins = round % 2; // with the second
    enum orl_result result = params->time(params->priv, begins, &ms[begins]);
    return result == ORL_OK ? params->time(params->priv, !begins, &ms[!begins]) : result;
}

// Mean distance from the median, as that of normal noise to its standard deviation: sqrt(pi / 2)
// again. A few frames that take far longer count for less than they do in squares.
static double deviation(const double *values, size_t count, double median)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += fabs(values[i] - median);
    return normal_noise * sum / (double)(count - 1);
}

bool orl_pair_timing_above(const struct orl_pair_timing *timing, double limit)
{
    return log(timing->ratio / limit) > clear * timing->error;
}

static bool is_settled(const struct orl_pair_timing_params *params,
                      const struct orl_pair_timing *timing)
{
    bool clear_of_limit = fabs(log(timing->ratio / params->limit)) > clear * timing->error;
    bool precise = params->error <= 0 || timing->error <= params->error;
    return timing->rounds >= ORL_PAIR_ROUNDS_MIN && clear_of_limit && precise;
}

enum orl_result orl_pair_timing_take(const struct orl_pair_timing_params *params,
                                     struct orl_pair_timing *timing)
{
    double logs[ORL_PAIR_ROUNDS_MAX], first[ORL_PAIR_ROUNDS_MAX];
    *timing = (struct orl_pair_timing){.error = INFINITY};
    while (timing->rounds < params->rounds_max && !is_settled(params, timing)) {
        double ms[2];
        size_t n = timing->rounds;
        ORL_TRY(take_round(params, n, ms));
        first[n] = ms[0];
        logs[n++] = log(ms[1] / ms[0]);
        timing->rounds = n;
        timing->ms = orl_median(first, n);
        double median = orl_median(logs, n);
        timing->ratio = exp(median);
        if (n >= 2)
            timing->error = normal_noise * fmax(deviation(logs, n, median), min_deviation) /
                            sqrt((double)n);
    }
    return ORL_OK;
}
