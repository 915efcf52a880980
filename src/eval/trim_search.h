// Private to oriel trim: states of a trimmed scene, and the search through them.
#ifndef ORL_EVAL_TRIM_SEARCH_H
#define ORL_EVAL_TRIM_SEARCH_H

#include "eval/trim.h"
#include "eval/trim_points.h"
#include "eval/validation.h"

// Levels of the parts, from the whole scene on.
enum { TRIM_POINT_LEVELS = 25, TRIM_DEPTH_LEVELS = 5 };
extern const double orl_trim_point_shares[TRIM_POINT_LEVELS];

// A scene in a state, ready to render.
struct trim_model {
    struct orl_scene scene; // shares what does not change with the search's scene
    struct orl_points points;
    struct orl_renderer *renderer;
    size_t point_bytes, photo_bytes; // on the device, with all photographs
};

// What is left of a scene, and what is known of it: the whole scene, a state that a step has made of
// the one before, or one that is on trial.
struct trim_state {
    struct trim_state *before; // owned by the search; NULL: this is the whole scene
    struct trim_model model;   // without a renderer: that of the state before serves
    bool shares;               // it does
    struct orl_trim_step step; // that made it
    // How small each part is; 0: as in the scene. Of textures an enum orl_textures; of depth maps n for
    // half floats at 1/n of the size. So many of the photographs in the search's order were to go; few may
    // have come back.
    size_t level[ORL_TRIM_PART_COUNT];
    struct orl_render_params render;
    size_t removed_count;
    struct orl_score score;      // by the search's targets
    struct orl_score_loss loss;  // against the whole scene
    double slower;               // the time of a frame, as a multiple of the whole scene's
    bool removed[];              // per photograph
};

struct trim_search {
    struct orl_gpu *gpu;
    const struct orl_log *log;
    const struct orl_scene *scene;
    const struct orl_trim_params *params;
    struct orl_trim *trim;
    const char *part; // the folder that becomes params->out when it is whole
    struct orl_point_ranking ranking;
    // All training photographs, those that look at a step first before the others that decide on it.
    struct orl_validation targets;
    size_t validation_count; // targets that look at a step first
    size_t deciding_count;   // targets that decide on it then, with these
    size_t *order;           // owned: targets in the order in which their photographs go
    struct orl_score_loss most; // the tolerances at this time; they grow towards a budget
    struct trim_state *first, *now; // owned, with all between them
    struct orl_render_params tuned; // options that may serve better
    double first_ms;
    double start_s;
};

bool orl_trim_has_budget(const struct trim_search *s);

// --- trim_state.c ---

// Begins a state of this part as the search's is, which the caller changes.
enum orl_result orl_trim_state_begin(const struct trim_search *s, enum orl_trim_part part,
                                     struct trim_state **out) ORL_CHECK_RESULT;
// Releases the state alone, which may be NULL.
void orl_trim_state_destroy(struct trim_state **state);
// How the scene is drawn in this state. Texts are static or the search's scene's.
struct orl_scene_defaults orl_trim_defaults(const struct trim_search *s, const struct trim_state *state);
// The model that the state is drawn with.
const struct trim_model *orl_trim_model_of(const struct trim_state *state);
enum orl_result orl_trim_model_open(const struct trim_search *s, struct trim_state *state) ORL_CHECK_RESULT;
// Closes the models of this state and of all before it.
void orl_trim_models_close(struct trim_state *state);
// Bytes of points and photographs on the device, without those in use only while a photograph is
// loaded.
void orl_trim_count_bytes(const struct orl_gpu *gpu, size_t *points, size_t *photos);
// The same of a state.
double orl_trim_model_bytes(const struct trim_search *s, const struct trim_state *state);
// Opens the model of a state on trial, unless it shares one. Then measures it by the targets that look
// first, and by all that decide unless the first lose far more than is allowed.
enum orl_result orl_trim_measure(struct trim_search *s, struct trim_state *t) ORL_CHECK_RESULT;
// Whether the losses are within the tolerances, of which the step may use this share of what is left.
bool orl_trim_fits(const struct trim_search *s, const struct orl_score_loss *loss, double share);
// The state on trial becomes the search's, and its step is reported. *t is NULL then.
enum orl_result orl_trim_take(struct trim_search *s, struct trim_state **t) ORL_CHECK_RESULT;
// Measures the targets that the search's state lacks.
enum orl_result orl_trim_measure_all(struct trim_search *s, struct orl_trim_figures *figures) ORL_CHECK_RESULT;
// Measures all targets, and takes the last steps back until they are within the tolerances.
enum orl_result orl_trim_confirm(struct trim_search *s) ORL_CHECK_RESULT;

// In the end a frame may take so many times as long as the whole scene's.
double orl_trim_slow_limit(const struct trim_search *s);
// Times frames of the whole scene, which the search begins with: first_ms.
enum orl_result orl_trim_time_first(struct trim_search *s) ORL_CHECK_RESULT;
// Compares frames of a state on trial with those of the state before: `slower`.
enum orl_result orl_trim_time_trial(struct trim_search *s, struct trim_state *t) ORL_CHECK_RESULT;
// Compares frames of the search's state with those of the whole scene, for the report. slow: they are
// clearly slower than they may be.
enum orl_result orl_trim_time_whole(struct trim_search *s, bool *slow) ORL_CHECK_RESULT;

// --- trim_ladder.c ---

// Takes the parts one after the other, each as far as the tolerances allow; with a budget until it
// holds.
enum orl_result orl_trim_climb(struct trim_search *s) ORL_CHECK_RESULT;
// Makes a frame that takes longer than it may faster: by cheaper options, or without compressed
// textures.
enum orl_result orl_trim_make_faster(struct trim_search *s) ORL_CHECK_RESULT;
// Takes the search's tuned options if they are better by the targets that decide.
enum orl_result orl_trim_take_tuned(struct trim_search *s) ORL_CHECK_RESULT;

// --- trim_photos.c ---

// The order in which photographs go: each time the one whose two nearest that are left are nearest.
enum orl_result orl_trim_order_photos(struct trim_search *s) ORL_CHECK_RESULT;
// Removes the first `count` in this order and measures. Photographs come back beside which views change
// by more than renderings there are wrong anyway: no training photograph decides on its own removal, as
// it is left out of its own view in any case. The nearest photographs to measured views that lose more
// than one may come back, too.
enum orl_result orl_trim_remove_photos(struct trim_search *s, size_t count,
                                       struct trim_state *t) ORL_CHECK_RESULT;

// --- trim_write.c ---

// Bytes of the scene's points, cameras, photographs that are not held out and their masks, on disk.
size_t orl_trim_scene_file_bytes(const struct orl_scene *scene);
// Writes the model's scene to the folder `out`, without the photographs that `removed` marks, drawn by
// the choice's method.
enum orl_result orl_trim_write_scene(const struct orl_log *log, const struct orl_scene *scene,
                                     const bool *removed, const struct orl_choice *choice,
                                     const char *out) ORL_CHECK_RESULT;

#endif
