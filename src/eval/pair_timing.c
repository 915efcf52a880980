#include "eval/pair_timing.h"

#include <math.h>

#include "eval/timing.h"

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

bool orl_pair_timing_below(const struct orl_pair_timing *timing, double limit)
{
    return log(limit / timing->ratio) > clear * timing->error;
}

static bool is_enough(const struct orl_pair_timing_params *params,
                      const struct orl_pair_timing *timing)
{
    bool clear_of_limit = orl_pair_timing_above(timing, params->limit) ||
                          orl_pair_timing_below(timing, params->limit);
    bool precise = params->error <= 0 || timing->error <= params->error;
    return timing->rounds >= ORL_PAIR_ROUNDS_MIN && clear_of_limit && precise;
}

enum orl_result orl_pair_timing_take(const struct orl_pair_timing_params *params,
                                     struct orl_pair_timing *timing)
{
    double logs[ORL_PAIR_ROUNDS_MAX], first[ORL_PAIR_ROUNDS_MAX];
    *timing = (struct orl_pair_timing){.error = INFINITY};
    while (timing->rounds < params->rounds_max && !is_enough(params, timing)) {
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
