// Private to oriel trim: the search through states.
#ifndef ORL_EVAL_TRIM_SEARCH_H
#define ORL_EVAL_TRIM_SEARCH_H

#include "eval/trim_internal.h"

// How well a view is rendered.
struct trim_score {
    double db, ssim;
};

// What a state loses against another: means over the views measured, and the greatest loss of one of
// them.
struct trim_loss {
    double db, ssim, worst_db;
};

// A state and what is known of it. `state.removed` and `score` are owned.
struct trim_standing {
    struct trim_state state;
    struct trim_score *score; // per target; NAN: not measured
    struct trim_loss loss;    // against the whole scene
    double bytes;
    double slower; // the time of a frame, as a multiple of the whole scene's; of a trial, of the state
                   // before it; 1: the same, or not timed
};

// A state on trial.
struct trim_trial {
    enum orl_trim_part part;
    char what[96];
    struct trim_standing now;
    struct trim_model *own; // NULL: the search's model serves
    struct trim_loss step;  // against the state before
};

struct trim_search {
    struct trim_source source;
    const struct orl_trim_params *params;
    struct orl_trim *trim;
    const char *part; // the folder that becomes params->out when it is whole
    struct orl_validation targets; // all training photographs
    size_t validation_count; // targets that look at a step first
    size_t deciding_count;   // targets that decide on it then
    size_t *order;           // owned: targets in the order in which their photographs go
    struct trim_score *first; // owned, per target: of the whole scene
    struct trim_loss most; // the tolerances at this time; they grow towards a budget
    struct trim_state first_state;
    struct trim_standing now;
    struct trim_model *model; // of `now`
    double first_ms;
    struct trim_standing *history; // owned: before each of the report's steps
    size_t history_count, history_capacity;
    double start_s;
};

// --- trim_ladder.c ---

// The i-th of `count` targets, evenly chosen.
size_t orl_trim_validation_view(const struct trim_search *s, size_t i, size_t count);
bool orl_trim_has_budget(const struct trim_search *s);
// Takes the parts one after the other, each as far as the tolerances allow; with a budget until it
// holds.
enum orl_result orl_trim_climb(struct trim_search *s) ORL_CHECK_RESULT;
// Makes a frame that takes longer than it may faster: by cheaper options, or without compressed
// textures.
enum orl_result orl_trim_make_faster(struct trim_search *s) ORL_CHECK_RESULT;
// Takes other options for the method if the deciding targets do not lose by it.
enum orl_result orl_trim_take_options(struct trim_search *s,
                                      const struct orl_render_params *render) ORL_CHECK_RESULT;

// --- trim_trial.c ---

void orl_trim_standing_finish(struct trim_standing *standing);
double orl_trim_model_bytes(const struct trim_search *s, const struct trim_model *model,
                            const struct trim_state *state);
// The model that the trial is drawn with.
const struct trim_model *orl_trim_trial_model(const struct trim_search *s, const struct trim_trial *t);
// Begins a trial with the search's state, which the caller changes.
enum orl_result orl_trim_trial_begin(struct trim_search *s, enum orl_trim_part part,
                                     struct trim_trial *t) ORL_CHECK_RESULT;
void orl_trim_trial_end(struct trim_trial *t);
// Opens the trial's model, unless the search's `shares` it. Then measures it by the targets that look
// first, and by all that decide unless the first lose far more than is allowed.
enum orl_result orl_trim_trial_measure(struct trim_search *s, struct trim_trial *t,
                                       bool shares) ORL_CHECK_RESULT;
// Whether the losses are within the tolerances, of which the step may use this share of what is left.
bool orl_trim_trial_fits(const struct trim_search *s, const struct trim_trial *t, double share);
// The trial's state becomes the search's.
enum orl_result orl_trim_trial_take(struct trim_search *s, struct trim_trial *t) ORL_CHECK_RESULT;
// Measures all targets in the search's state. `first`: the whole scene, with which later states are
// compared.
enum orl_result orl_trim_measure_all(struct trim_search *s, bool first,
                                     struct orl_trim_figures *figures) ORL_CHECK_RESULT;
// Measures all targets, and takes the last steps back until they are within the tolerances.
enum orl_result orl_trim_confirm(struct trim_search *s) ORL_CHECK_RESULT;

// --- trim_photos.c ---

// The order in which photographs go: each time the one whose two nearest that are left are nearest.
enum orl_result orl_trim_order_photos(struct trim_search *s) ORL_CHECK_RESULT;
// Photographs come back beside which views change by more than renderings there are wrong anyway: no
// training photograph decides on its own removal, as it is left out of its own view in any case.
enum orl_result orl_trim_put_back(struct trim_search *s,
                                  struct trim_state *state) ORL_CHECK_RESULT;

// The nearest photographs to measured views that lose more than one may come back; the trial then has
// to be measured again. False: there are none.
bool orl_trim_mend(const struct trim_search *s, struct trim_trial *t);

// --- trim_time.c ---

// In the end a frame may take so many times as long as the whole scene's.
double orl_trim_slow_limit(const struct trim_search *s);
// Times frames of the whole scene, which the search begins with: first_ms.
enum orl_result orl_trim_time_first(struct trim_search *s) ORL_CHECK_RESULT;
// Compares frames of a trial with those of the model so far: `slower`.
enum orl_result orl_trim_time_trial(struct trim_search *s, struct trim_trial *t) ORL_CHECK_RESULT;
// Compares frames of the state, whose model is open, with those of the whole scene, for the report.
// slow: they are clearly slower than they may be.
enum orl_result orl_trim_time_whole(struct trim_search *s, bool *slow) ORL_CHECK_RESULT;

#endif
