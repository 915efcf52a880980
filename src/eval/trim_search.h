// Private to oriel trim: the search through states.
#ifndef ORL_EVAL_TRIM_SEARCH_H
#define ORL_EVAL_TRIM_SEARCH_H

#include "eval/trim_internal.h"

enum { TRIM_NEAR = 4, TRIM_BETWEEN = 3, TRIM_VIEWS_MAX = 64 };

// How well a view is rendered.
struct trim_score {
    double db, ssim;
};

// What was measured of a step.
struct trim_measured {
    double loss_db, loss_ssim;
    double slower;        // the time of a frame is multiplied by this
    bool slow;            // a frame would take longer than it may on the way
    double total_loss_db; // before the step
    double between_db;   // of a photograph: the greatest change of views beside it
    double beside_db;    // and their mean, as a share of all targets
    size_t view_count;
    size_t views[TRIM_VIEWS_MAX]; // indices of targets
    struct trim_score before[TRIM_VIEWS_MAX], score[TRIM_VIEWS_MAX]; // without and with the step
};

// A kind of step that can be taken next.
struct trim_move {
    enum orl_trim_part part;
    size_t index;     // of a photograph, of a row of options, a kind of textures, or levels of
                      // points that are taken at once
    double ratio;     // what it promises: saved shares per dB; INFINITY: not known yet
    bool tried;
    bool dead;    // it cannot be taken any more: it saves nothing, or has been taken
    bool blocked; // it loses too much or takes too long, unless other steps gain
    bool slow;    // it is blocked by the time of a frame alone
    size_t version;   // of the search's state that it was measured in
    struct trim_measured measured;
};

// A step that was taken: the state before it, which is owned.
struct trim_past {
    struct trim_state state;
    double slower; // of that state
    size_t step; // index of the report's step
    struct trim_move *move; // that led from this state; NULL: tuned options
};

struct trim_search {
    struct trim_source source;
    const struct orl_trim_params *params;
    struct orl_trim *trim;
    const char *part; // the folder that becomes params->out when it is whole
    struct orl_validation targets; // all training photographs
    size_t validation_count; // targets that judge what changes all views
    size_t (*nearest)[TRIM_NEAR]; // owned, per target: the others that stand nearest
    size_t near_count;
    double *first_db;       // owned, per target: PSNR of the whole scene
    struct trim_score *now; // owned, per target: in the state reached; NAN: not known
    double *lost_db;        // owned, per target: loss so far, estimated where `now` is not known
    struct trim_state first_state, state;
    struct trim_model *model;  // of `state`
    size_t version;            // counts the steps taken, and their confirmations
    size_t changed;            // the version since which all views have changed
    double bytes, file_bytes, total_loss_db, total_loss_ssim; // of `state`
    double slower; // the time of its frame, as a multiple of the whole scene's
    bool slow;     // all that was confirmed last is clearly slower than the whole scene
    bool options_only; // nothing but cheaper options of the method is tried
    double first_bytes, first_file_bytes, first_ms;
    struct trim_move *moves; // owned
    size_t move_count;
    struct trim_past *history; // owned
    size_t history_count, history_capacity;
    size_t confirmed; // steps that all targets have confirmed
    double start_s;
};

// --- trim_moves.c ---

// Lists the moves that the scene and the parameters allow.
enum orl_result orl_trim_plan(struct trim_search *s) ORL_CHECK_RESULT;
// The i-th of `count` targets, evenly chosen.
size_t orl_trim_validation_view(const struct trim_search *s, size_t i, size_t count);
bool orl_trim_is_possible(const struct trim_search *s, const struct trim_move *move);
// Whether the step changes the splats, so that the photographs' depth maps are drawn anew.
bool orl_trim_redraws_depth(const struct trim_move *move);
// Takes the move's next step in `state`, and describes it.
void orl_trim_apply(const struct trim_search *s, const struct trim_move *move,
                    struct trim_state *state, char what[96]);

// --- trim_trial.c ---

// Figures of one target in a state, the target being left out; brief: PSNR and SSIM alone.
enum orl_result orl_trim_measure_view(struct trim_search *s, struct orl_renderer *renderer,
                                      const struct trim_state *state, size_t view,
                                      bool brief,
                                      struct orl_metrics *metrics) ORL_CHECK_RESULT;
double orl_trim_model_bytes(const struct trim_search *s, const struct trim_model *model,
                            const struct trim_state *state);
// Measures a move, and takes it when it is allowed and no other promises more. The search must not
// be within its budget yet.
enum orl_result orl_trim_try(struct trim_search *s, struct trim_move *move) ORL_CHECK_RESULT;
// Takes other options for the method if the targets together (of many, some) do not lose by it. Nothing may have
// been taken before.
enum orl_result orl_trim_take_options(struct trim_search *s,
                                      const struct orl_render_params *render) ORL_CHECK_RESULT;
bool orl_trim_has_budget(const struct trim_search *s);
// What changes beside a photograph that goes: between_db and beside_db of `m`, with the photographs
// of `state` removed. stays: more than it may.
enum orl_result orl_trim_measure_between(struct trim_search *s, size_t target,
                                         const struct trim_state *state, struct trim_measured *m,
                                         bool *stays) ORL_CHECK_RESULT;
// Takes a step whose losses are known.
enum orl_result orl_trim_take_measured(struct trim_search *s,
                                       struct trim_move *move) ORL_CHECK_RESULT;
// The move that promises most, other than `except`; NULL: none is left.
struct trim_move *orl_trim_best_move(const struct trim_search *s, const struct trim_move *except);

// Steps that were blocked may be possible again: what was lost, or the time of a frame, has changed.
void orl_trim_make_room(struct trim_search *s);

// --- trim_photos.c ---

// Whether so many photographs can be tried that they are removed in groups.
bool orl_trim_has_group(const struct trim_search *s);
// Removes a group of photographs, as far as the tolerances allow.
enum orl_result orl_trim_try_group(struct trim_search *s) ORL_CHECK_RESULT;

// --- trim_time.c ---

struct trim_drawn {
    struct orl_renderer *renderer;
    const struct trim_state *state;
};
// In the end a frame may take so many times as long as the whole scene's, and on the way.
double orl_trim_slow_limit(const struct trim_search *s);
double orl_trim_slow_limit_on_way(const struct trim_search *s);
// Times frames of the whole scene, which the search begins with: first_ms.
enum orl_result orl_trim_time_first(struct trim_search *s) ORL_CHECK_RESULT;
// Compares frames of a step on trial with those of the model so far: the measured `slower` and
// `slow`.
enum orl_result orl_trim_time_trial(struct trim_search *s, const struct trim_drawn *trial,
                                    struct trim_measured *m) ORL_CHECK_RESULT;
// Compares frames of the state, whose model is open, with those of the whole scene, for the report.
// slow: they are clearly slower than they may be in the end.
enum orl_result orl_trim_time_whole(struct trim_search *s, bool *slow) ORL_CHECK_RESULT;

// --- trim_confirm.c ---

// What is confirmed, and what steps are taken back for: losses alone; losses, but the time of a
// frame is measured too; both.
enum trim_confirmation { TRIM_CONFIRM_LOSSES, TRIM_CONFIRM_TIMED, TRIM_CONFIRM_LAST };

// Measures all targets. `first`: the whole scene, with which later states are compared.
enum orl_result orl_trim_measure_all(struct trim_search *s, bool first,
                                     struct orl_trim_figures *figures) ORL_CHECK_RESULT;
// Measures all targets and takes back what breaks a tolerance. The search goes on with the measured
// losses and time.
enum orl_result orl_trim_confirm(struct trim_search *s,
                                 enum trim_confirmation kind) ORL_CHECK_RESULT;

// What all targets say of the state.
struct trim_check {
    enum trim_confirmation kind;
    bool lost, slow; // it loses more than it may, or its frame takes too long
};
// Measures the state, whose model is open, by all targets.
enum orl_result orl_trim_check(struct trim_search *s,
                               struct trim_check *check) ORL_CHECK_RESULT;

// --- trim_repair.c ---

// Takes one step of the history back; those after it stay. Its move can not be taken again. The
// model stays as it was.
enum orl_result orl_trim_undo(struct trim_search *s, size_t step) ORL_CHECK_RESULT;
// Takes back what brings the state, which breaks a tolerance, nearest to it for what it saves. The
// model is that of the new state.
enum orl_result orl_trim_repair(struct trim_search *s,
                                const struct trim_check *check) ORL_CHECK_RESULT;

// --- trim_random.c ---

// Measures the scene with points and photographs removed at random.
enum orl_result orl_trim_compare_random(struct trim_search *s) ORL_CHECK_RESULT;

#endif
