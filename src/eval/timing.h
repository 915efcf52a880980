// How every command times frames. After warm-up, timed frames read nothing back and end when the
// device is done. Passes are timed in separate frames, since a pass timer drains a software
// renderer's pipeline.
#ifndef ORL_EVAL_TIMING_H
#define ORL_EVAL_TIMING_H

#include "oriel/progress.h"
#include "oriel/render.h"

enum { ORL_TIMING_PASSES_MAX = 32, ORL_TIMING_FRAMES_MIN = 3 };

struct orl_timing_params {
    // Draws frame `number` and returns when the device is done.
    enum orl_result (*draw)(void *priv, size_t number);
    void *priv;
    size_t views;       // number of views, which frames cycle through equally often
    size_t warm_up;     // cycles before the first timed frame
    double seconds;     // approximate duration of timed frames; at least ORL_TIMING_FRAMES_MIN are
                        // timed
    size_t frames_max;  // greatest number of timed frames, at least ORL_TIMING_FRAMES_MIN
    size_t pass_frames; // frames behind each pass's time, at most the number of timed frames; 0:
                        // none
    const struct orl_progress *progress;
};

struct orl_timing_pass {
    const char *name;
    double ms;
};

struct orl_timing {
    size_t frames;
    double median_ms, slowest_ms; // from the call until the device is done
    double cpu_ms; // median processor time of all threads: on a software renderer the cost of the
                   // frame, nearly independent of other programs
    struct orl_timing_pass passes[ORL_TIMING_PASSES_MAX]; // medians
    size_t pass_count;
};

enum orl_result orl_timing_take(struct orl_gpu *gpu, const struct orl_timing_params *params,
                                struct orl_timing *timing) ORL_CHECK_RESULT;

// Of a sequence: frame `number` shows the time step after that of the frame before, so that its time
// includes the hull and the upload of its photographs. A still scene stays as it is.
enum orl_result orl_timing_show_time_step(struct orl_gpu *gpu, struct orl_scene *scene,
                                          struct orl_renderer *renderer,
                                          size_t number) ORL_CHECK_RESULT;

// The pass of this name among `passes`, of which there are at most ORL_TIMING_PASSES_MAX; added if it
// is new. NULL: there is no room for it.
struct orl_timing_pass *orl_timing_pass(struct orl_timing_pass *passes, size_t *count,
                                        const char *name);
// Median of the values, which it sorts. 0 when count is 0.
double orl_median(double *values, size_t count);

// --- pairs ---

// Which of two ways to draw a frame takes longer, beside other programs that disturb every time.
// Frames are drawn in the order A B, B A, A B, ..., so that a machine that becomes slower or faster
// meanwhile slows both alike. Each round of two gives one ratio, and their median decides. There
// are more rounds where it is close to what is asked (a sequential test, Wald 1945).
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
// Whether the ratio is clearly above the limit: by three standard errors.
bool orl_pair_timing_above(const struct orl_pair_timing *timing, double limit);

#endif
