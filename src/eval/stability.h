// How steady a method is while the viewer moves: each frame of a walk, warped to the next
// viewpoint by the next frame's depth, should be the next frame. docs/reference/metrics.md.
#ifndef ORL_EVAL_STABILITY_H
#define ORL_EVAL_STABILITY_H

#include "oriel/progress.h"
#include "eval/choice.h"
#include "oriel/render.h"
#include "oriel/path.h"

// Side of the blocks whose mean colours are compared, pixels.
enum { ORL_STABILITY_BLOCK = 16 };

// One frame to the next. Differences are absolute, of 8-bit sRGB values, a pixel's being the
// mean of its three channels.
struct orl_stability_step {
    double compared; // share of the pixels that both frames cover with one surface
    double mean;     // of the compared pixels
    double p99;      // that 99 % of the compared pixels do not exceed
    // What interpolation alone adds to `mean`, about: half of what the second frame loses
    // when it is moved by the same parts of a pixel, and back.
    double floor;
    // Differences of the mean colours of 16x16 blocks at least half of which were compared:
    // interpolation, noise and detail cancel out, what pops does not.
    double block_mean, block_worst;
    int block_x, block_y; // of the worst, its upper left pixel in the second frame
    double jump;          // of the mean colour of all compared pixels
};

struct orl_stability {
    const char *method; // not owned
    char device[128];
    int width, height;
    struct orl_stability_step *steps; // owned; step i leads from frame i to frame i + 1
    size_t step_count;
    // Means over the steps; but p99 is that of all pixels of all steps, block_worst and jump
    // are the largest, with the block's place.
    struct orl_stability_step all;
    size_t worst_block_step, worst_jump_step;
    double render_ms; // mean
};

struct orl_stability_params {
    const char *method; // name for reports
    const struct orl_render_params *render;
    const struct orl_view *views; // at least two, in the order of the walk
    size_t view_count;
    // Photographs that frame i may not use, for the renderer; NULL: none are forbidden.
    const bool *(*skip)(void *priv, size_t frame);
    void *skip_priv;
    const char *image_dir; // frames are kept as METHOD.NNNNN.png here, made if need be; or NULL
    const struct orl_progress *progress;
};

// A walk past the photographs that are not held out, in name order, in pictures of the
// first one's size divided by `divide`.
enum orl_result orl_stability_walk(const struct orl_log *log, const struct orl_scene *scene,
                                   size_t frames, int divide,
                                   struct orl_path *path) ORL_CHECK_RESULT;
enum orl_result orl_stability_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                                  const struct orl_stability_params *params,
                                  struct orl_stability *out) ORL_CHECK_RESULT;
void orl_stability_finish(struct orl_stability *stability);

struct orl_walk_params {
    const struct orl_choice *choices;
    size_t choice_count;
    int frames, divide;    // of orl_stability_walk
    const char *image_dir; // of struct orl_stability_params
    void (*on_result)(void *priv, const struct orl_stability *one); // may be NULL
    void *priv;
    const struct orl_progress *progress;
};
// Each choice along the same walk, into results[choice_count]; each to be finished.
enum orl_result orl_stability_walk_all(struct orl_gpu *gpu, struct orl_renderer *renderer,
                                       const struct orl_scene *scene,
                                       const struct orl_walk_params *params,
                                       struct orl_stability *results) ORL_CHECK_RESULT;

// One picture of the walk.
struct orl_stability_frame {
    struct orl_view view;
    struct orl_image srgb;            // U8 x3
    struct orl_image depth, coverage; // as in struct orl_frame
};
// Counts of pixels by the sum of their three channels' differences.
struct orl_stability_counts {
    size_t of[3 * 255 + 1];
};
// Compares two pictures; adds to *counts.
enum orl_result orl_stability_compare(const struct orl_log *log,
                                      const struct orl_stability_frame *before,
                                      const struct orl_stability_frame *after,
                                      struct orl_stability_counts *counts,
                                      struct orl_stability_step *step) ORL_CHECK_RESULT;

// The JSON of docs/reference/metrics.md, released with free(): one object, or with `array` an
// array of `count` of them.
char *orl_stability_to_json(const struct orl_log *log, const struct orl_scene *scene,
                            const struct orl_stability *all, size_t count, bool array);

#endif
