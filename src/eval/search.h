// The search for options that suit a scene: values are tried one after the other on training
// photographs, each rendered without itself, and what is better is kept. oriel tune and oriel trim move
// one method's numbers. Held-out photographs are neither used nor compared with.
#ifndef ORL_EVAL_SEARCH_H
#define ORL_EVAL_SEARCH_H

#include <jansson.h>

#include "eval/choice.h"
#include "eval/validation.h"
#include "oriel/option_row.h"
#include "oriel/progress.h"

enum { ORL_SEARCH_DIVIDE_MAX = 16 };

// One measured choice.
struct orl_trial {
    double psnr_db, ssim;              // means over the photographs, whole pictures
    const char *key;                   // the changed option; NULL: a start
    double value;
    bool kept;                         // better than all before (orl_score_better)
};

// views 0: all. With a budget, the result depends on the machine's speed.
#define ORL_SEARCH_OPTIONS(ROW) \
    ROW(budget_s, "budget", NUMBER(0, 0, 1e6, "SECONDS"), \
        "start no trial after so long; default: none") \
    ROW(views, "views", INT(16, 1, 100000, "N"), "photographs to compare with, at most") \
    ROW(size_divide, "size-divide", INT(1, 1, ORL_SEARCH_DIVIDE_MAX, "N"), "compare at 1/N of their size") \
    ROW(gain_db, "gain", NUMBER(0.01, 0, 10, "DB"), "a change must bring so much")
struct orl_search_params {
    ORL_SEARCH_OPTIONS(ORL_OPTION_MEMBER)
    void (*on_trial)(void *priv, const struct orl_trial *trial); // may be NULL
    void *priv;
    const struct orl_progress *progress;
};

struct orl_search {
    const struct orl_log *log;
    struct orl_renderer *renderer; // not owned
    const struct orl_scene *scene; // not owned
    struct orl_search_params params;
    struct orl_validation validation;
    struct orl_choice best;
    struct orl_score score;   // of it
    struct orl_trial *trials; // owned; the first is the start
    size_t trial_count, trial_capacity;
    double start_s, planned; // planned: estimate of the trials, for the progress report
    bool complete;           // ended because no value was better; false: the time ran out
};

// Measures `start` and searches on from it: a complete search. keys: these options alone; NULL or
// none: all. On failure it is finished. ORL_ERR_ARGUMENT: a key cannot be tuned; ORL_ERR_DATA: fewer
// than ORL_VALIDATION_TRAIN_MIN training photographs.
enum orl_result orl_search_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                               const struct orl_scene *scene,
                               const struct orl_search_params *params,
                               const struct orl_choice *start, const struct orl_names *keys,
                               struct orl_search *search) ORL_CHECK_RESULT;
void orl_search_finish(struct orl_search *search);

// Sets scene->backdrop_rests, of the renderer's scene: whether pictures come closer by params->gain_db when what lies
// behind the points stays at its place in the photographs, as behind a turntable. Errors are those of orl_search_run.
enum orl_result orl_search_backdrop(const struct orl_log *log, struct orl_renderer *renderer, struct orl_scene *scene,
                                    const struct orl_search_params *params,
                                    const struct orl_choice *choice) ORL_CHECK_RESULT;

// What was found as the record that scene.json has under "tuned". A new reference; NULL: no memory.
json_t *orl_search_record(const struct orl_search *search);
// The same with all trials (docs/reference/json.md).
json_t *orl_search_report(const struct orl_search *search, const char *device);

#endif
