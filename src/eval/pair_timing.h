// Which of two ways to draw a frame takes longer, beside other programs that disturb every time.
// Frames are drawn in the order A B, B A, A B, ..., so that a machine that becomes slower or faster
// meanwhile slows both alike. Each round of two gives one ratio, and their median decides. There
// are more rounds where it is close to what is asked (a sequential test, Wald 1945).
#ifndef ORL_EVAL_PAIR_TIMING_H
#define ORL_EVAL_PAIR_TIMING_H

#include "oriel/log.h"

enum { ORL_PAIR_ROUNDS_MIN = 4, ORL_PAIR_ROUNDS_MAX = 128 };

struct orl_pair_timing_params {
    // Draws one frame, of the second way if `second`, and gives its time in ms.
    enum orl_result (*time)(void *priv, bool second, double *ms);
    void *priv;
    double limit;       // the ratio that is asked about
    double error;       // the standard error of the ratio's logarithm that is asked for as well;
                        // 0: only whether the ratio is above or below the limit
    size_t rounds_max; // at most ORL_PAIR_ROUNDS_MAX
};

struct orl_pair_timing {
    double ms;    // median frame of the first way
    double ratio; // median of a round's second time divided by its first
    double error; // standard error of the ratio's logarithm
    size_t rounds;
};

enum orl_result orl_pair_timing_take(const struct orl_pair_timing_params *params,
                                     struct orl_pair_timing *timing) ORL_CHECK_RESULT;
// Whether the ratio is clearly on that side of the limit: by three standard errors.
bool orl_pair_timing_above(const struct orl_pair_timing *timing, double limit);
bool orl_pair_timing_below(const struct orl_pair_timing *timing, double limit);

#endif
