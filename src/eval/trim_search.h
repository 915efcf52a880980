// Private to oriel trim: states of a trimmed scene, and the search through them.
#ifndef ORL_EVAL_TRIM_SEARCH_H
#define ORL_EVAL_TRIM_SEARCH_H

#include "eval/trim.h"
#include "eval/validation.h"

// --- trim_points.c: points are ranked by what they contribute to pictures, and a smaller cloud is made of the first ---

struct orl_point_ranking {
    uint32_t *order; // owned: indices into the scene's points, the most important first
    uint32_t *pixels; // owned, per point of the scene: pixels of all views that it wins
    size_t count;
};
// Ranks by the views of training photographs and views between neighbours, at most `max_views` > 0. At
// every pixel of coarser and coarser pictures of a view one point of the nearest surface is chosen:
// that which wins the most pixels of all views. A point ranks by the coarsest picture that it is
// chosen in, then by its pixels. So the points that no view shows are last, those that only full
// resolution needs are before them, and a first part of the order is spread evenly over pictures.
enum orl_result orl_point_ranking_make(struct orl_gpu *gpu, const struct orl_scene *scene,
                                       size_t max_views, const struct orl_progress *progress,
                                       struct orl_point_ranking *ranking) ORL_CHECK_RESULT;
void orl_point_ranking_finish(struct orl_point_ranking *ranking);

// Makes a cloud of the first `count` points of `order`, with radii that close the gaps. Each point
// takes the place of the points that it stands for: along its normal it moves to their mean, and its
// normal and colour become theirs.
enum orl_result orl_points_thin_out(const struct orl_log *log, const struct orl_points *from,
                                    const uint32_t *order, size_t count,
                                    struct orl_points *to) ORL_CHECK_RESULT;

// --- the search ---

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
    struct orl_point_ranking ranking;
    // All training photographs, those that look at a step first before the others that decide on it.
    struct orl_validation targets;
    size_t validation_count; // targets that look at a step first
    size_t deciding_count;   // targets that decide on it then, with these
    size_t *order;           // owned: photographs in the order in which they go
    struct orl_score_loss most; // the tolerances at this time; they grow towards a budget
    struct trim_state *first, *now; // owned, with all between them
    struct orl_render_params tuned; // options that may serve better
    double first_ms;
    double start_s;
};

// --- trim_search.c ---

// The whole search: s->now is the least state then, and s->trim tells of it.
enum orl_result orl_trim_search(struct trim_search *s) ORL_CHECK_RESULT;
void orl_trim_search_finish(struct trim_search *s);
// Begins a state of this part as the search's is, which the caller changes.
enum orl_result orl_trim_state_begin(const struct trim_search *s, enum orl_trim_part part,
                                     struct trim_state **out) ORL_CHECK_RESULT;
// Releases the state alone, which may be NULL.
void orl_trim_state_destroy(struct trim_state **state);
// The model that the state is drawn with.
const struct trim_model *orl_trim_model_of(const struct trim_state *state);
enum orl_result orl_trim_model_open(const struct trim_search *s, struct trim_state *state) ORL_CHECK_RESULT;
// Closes the models of this state and of all before it.
void orl_trim_models_close(struct trim_state *state);
// Bytes of points and photographs on the device, without those in use only while a photograph is
// loaded.
void orl_trim_count_bytes(const struct orl_gpu *gpu, size_t *points, size_t *photos);
// Opens the model of a state on trial, unless it shares one. Then measures it by the targets that look
// first, and by all that decide unless the first lose far more than is allowed.
enum orl_result orl_trim_measure(struct trim_search *s, struct trim_state *t) ORL_CHECK_RESULT;
// The state on trial becomes the search's, and its step is reported. *t is NULL then.
enum orl_result orl_trim_take(struct trim_search *s, struct trim_state **t) ORL_CHECK_RESULT;
// Measures the targets that the search's state lacks.
enum orl_result orl_trim_measure_all(struct trim_search *s, struct orl_trim_figures *figures) ORL_CHECK_RESULT;
// Measures all targets, and takes the last steps back until they are within the tolerances.
enum orl_result orl_trim_confirm(struct trim_search *s) ORL_CHECK_RESULT;

// --- trim_photos.c ---

// The order in which photographs go: each time the one whose two nearest that are left are nearest.
enum orl_result orl_trim_order_photos(struct trim_search *s) ORL_CHECK_RESULT;
// Removes the first `count` in this order and measures. Photographs come back beside which views change
// by more than renderings there are wrong anyway: no training photograph decides on its own removal, as
// it is left out of its own view in any case. The nearest photographs to measured views that lose more
// than one may come back, too.
enum orl_result orl_trim_remove_photos(struct trim_search *s, size_t count,
                                       struct trim_state *t) ORL_CHECK_RESULT;

#endif
