// Fits a method's options to a scene: training photographs are rendered, each without using itself.
// Held-out photographs take no part: they are neither used nor compared with.
#ifndef ORL_EVAL_TUNE_H
#define ORL_EVAL_TUNE_H

#include "oriel/progress.h"
#include "oriel/render.h"

// One measured set of values.
struct orl_tune_trial {
    const char *key; // the changed option; NULL: the starting values
    double value;
    double psnr_db, ssim; // means over the photographs, whole pictures
    bool kept;            // better than all before (orl_score_better)
};

struct orl_tune_params {
    const char *method;                    // for reports
    const struct orl_render_params *start; // starting values
    const struct orl_names *keys;          // options to tune; NULL or none: all that are tunable
    int size_divide;   // pictures have 1/n of the photographs' size, [1, 16]
    size_t views;      // greatest number of photographs to compare with, evenly chosen; 0: all
    double gain_db;    // a change is kept when it is better by at least this much (score.h)
    double budget_s;   // no new trial starts after this time; 0: no limit. With a limit, the result
                       // depends on the machine's speed
    void (*on_trial)(void *priv, const struct orl_tune_trial *trial); // may be NULL
    void *priv;
    const struct orl_progress *progress;
};

struct orl_tune {
    struct orl_tune_trial *trials; // owned; the first has the starting values
    size_t trial_count, trial_capacity;
    size_t views;                  // photographs compared with
    bool complete;                 // ended because no value was better; false: the time ran out
    struct orl_render_params best;
    double start_db, best_db, best_ssim; // PSNR and SSIM
};

// Searches one option after another among its values in orl_render_tries, upwards and downwards
// while the result gets better. Repeats rounds over all options until a round brings no gain.
// ORL_ERR_ARGUMENT: a key is not tunable. ORL_ERR_DATA: fewer than three photographs.
enum orl_result orl_tune_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                             const struct orl_scene *scene, const struct orl_tune_params *params,
                             struct orl_tune *tune) ORL_CHECK_RESULT;
void orl_tune_finish(struct orl_tune *tune);

#endif
