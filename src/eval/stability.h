// Temporal stability: how little a method flickers while the viewer moves. Each frame of a walk,
// warped to the next viewpoint by the next frame's depth, should equal the next frame
// (docs/reference/metrics.md).
#ifndef ORL_EVAL_STABILITY_H
#define ORL_EVAL_STABILITY_H

#include "oriel/progress.h"
#include "eval/choice.h"
#include "oriel/render.h"
#include "oriel/path.h"

// Side in pixels of the blocks whose mean colours are compared.
enum { ORL_STABILITY_BLOCK = 16 };

// From one frame to the next. Differences are absolute, in 8-bit sRGB values; a pixel's difference
// is the mean of its three channels'.
struct orl_stability_step {
    size_t pixels;   // that are compared, where both frames show one surface
    double compared; // fraction of all pixels
    double mean;     // of the compared pixels
    double p99;      // 99th percentile over the compared pixels
    // Estimate of what interpolation alone adds to `mean`: half of the second frame's difference
    // after it is moved by the same fractions of a pixel, and back.
    double floor;
    size_t blocks; // 16x16 blocks with at least half of their pixels compared
    // Differences of their mean colours. Interpolation, noise and detail cancel out; popping remains.
    double block_mean, block_worst;
    int block_x, block_y; // upper left pixel of the worst block in the second frame
    double jump;          // difference of the mean colour of all compared pixels
};

struct orl_stability {
    const char *method; // not owned
    char device[128];
    int width, height;
    struct orl_stability_step *steps; // owned; step i leads from frame i to frame i + 1
    size_t step_count;
    // Over the pixels and blocks of all steps. Exceptions: compared is the mean of the steps;
    // block_worst (with its place) and jump are the largest.
    struct orl_stability_step all;
    size_t worst_block_step, worst_jump_step;
    double render_ms; // mean
};

struct orl_stability_params {
    const struct orl_choice *choice;
    const struct orl_path *path; // at least two views, in the order of the walk
    // Photographs that the renderer may not use in frame i; NULL: it may use all.
    const bool *(*skip)(void *priv, size_t frame);
    void *skip_priv;
    const char *image_dir; // folder for frames METHOD.NNNNN.png, made if needed; NULL: none
    const struct orl_progress *progress;
};

// Makes a walk past the photographs that are not held out, in order of name, with pictures of the
// first photograph's size divided by `divide`. file: takes the views of this file (orl_path_read)
// instead, at their size divided by `divide`; NULL: the walk.
enum orl_result orl_stability_walk(const struct orl_log *log, const struct orl_scene *scene, const char *file,
                                   size_t frames, int divide, struct orl_path *path) ORL_CHECK_RESULT;
enum orl_result orl_stability_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                                  const struct orl_stability_params *params,
                                  struct orl_stability *out) ORL_CHECK_RESULT;
void orl_stability_finish(struct orl_stability *stability);
// The report (docs/reference/json.md). A new reference; NULL: no memory.
json_t *orl_stability_report(const struct orl_scene *scene, const struct orl_stability *stability);

// One picture of the walk: all of its images are as large as the view.
struct orl_stability_frame {
    struct orl_view view;
    struct orl_image srgb;            // U8 x3
    struct orl_image depth, coverage; // as in struct orl_frame
};
// Numbers of pixels by the sum of the differences of their three channels.
struct orl_stability_counts {
    size_t of[3 * 255 + 1];
};
// Compares two pictures and adds to *counts.
void orl_stability_compare(const struct orl_stability_frame *before,
                           const struct orl_stability_frame *after,
                           struct orl_stability_counts *counts, struct orl_stability_step *step);

#endif
