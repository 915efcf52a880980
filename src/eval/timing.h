// How a frame is timed, by all that quote a frame's time: after frames to warm up, over frames
// that read nothing back, the device done at the end of each; passes in frames of their own,
// since a pass timer drains a software renderer's pipeline.
#ifndef ORL_EVAL_TIMING_H
#define ORL_EVAL_TIMING_H

#include "oriel/progress.h"
#include "oriel/gpu.h"

enum { ORL_TIMING_PASSES_MAX = 32, ORL_TIMING_FRAMES_MIN = 3 };

struct orl_timing_params {
    // Draws frame `number`; the device is done when it returns.
    enum orl_result (*draw)(void *priv, size_t number);
    void *priv;
    size_t views;       // that frames go round: each is drawn as often as the others
    size_t warm_up;     // rounds of views before the first timed frame
    double seconds;     // of timed frames, about, but no fewer than ORL_TIMING_FRAMES_MIN
    size_t frames_max;  // and no more than so many, at least ORL_TIMING_FRAMES_MIN
    size_t pass_frames; // frames behind each pass's time, at most as many as were timed; 0: none
    const struct orl_progress *progress;
};

struct orl_timing_pass {
    const char *name;
    double ms;
};

struct orl_timing {
    size_t frames;
    double median_ms, p95_ms, slowest_ms; // from the call until the device is done
    double cpu_ms; // median of the processor time of all threads: on a software renderer the
                   // frame's cost, which other work on the machine hardly changes
    struct orl_timing_pass passes[ORL_TIMING_PASSES_MAX]; // medians
    size_t pass_count;
};

enum orl_result orl_timing_take(struct orl_gpu *gpu, const struct orl_timing_params *params,
                                struct orl_timing *timing) ORL_CHECK_RESULT;

// Are so many frames, the first begun at start_s, enough?
bool orl_timing_enough(const struct orl_timing_params *params, size_t frames, double start_s);
// Sorts the values. 0 of none.
double orl_median(double *values, size_t count);

#endif
