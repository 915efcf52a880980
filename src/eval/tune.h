// A method's numbers fitted to a scene: training photographs rendered each without itself.
// Held-out photographs take no part: they are neither shown nor compared with.
#ifndef ORL_EVAL_TUNE_H
#define ORL_EVAL_TUNE_H

#include "oriel/progress.h"
#include "oriel/render.h"

// One set of values, measured.
struct orl_tune_trial {
    const char *key; // what was changed; NULL: the start
    double value;
    double psnr_db, ssim; // means over the photographs, whole pictures
    bool kept;            // better than all before
};

struct orl_tune_params {
    const char *method;                    // name, for reports
    const struct orl_render_params *start; // values to start from
    const struct orl_names *keys;          // tune only these; NULL or none: all that are tunable
    int size_divide;   // pictures of 1/n of the photographs' size, [1, 16]
    size_t views;      // photographs to compare with, at most, evenly chosen; 0: all
    double gain_db;    // a change must be better by this much to be kept
    double budget_s;   // no new trial after this long; 0: no limit. Only with it does the
                       // result depend on the machine's speed
    void (*on_trial)(void *priv, const struct orl_tune_trial *trial); // may be NULL
    void *priv;
    const struct orl_progress *progress;
};

struct orl_tune {
    struct orl_tune_trial *trials; // owned; the first is the start
    size_t trial_count, trial_capacity;
    size_t views;                  // photographs compared with
    bool complete;                 // ended because nothing got better, not for want of time
    struct orl_render_params best;
    double start_db, best_db;
};

// Searches one option after another among its values in orl_render_tries, upwards and
// downwards from its value as long as it gets better; in rounds, until one brings nothing.
// ORL_ERR_ARGUMENT: a key that is not tunable. ORL_ERR_DATA: fewer than three photographs.
enum orl_result orl_tune_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                             const struct orl_scene *scene, const struct orl_tune_params *params,
                             struct orl_tune *tune) ORL_CHECK_RESULT;
void orl_tune_finish(struct orl_tune *tune);

#endif
