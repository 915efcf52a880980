// Chooses how a scene is drawn: the method, its options and the renderer's settings, from training
// photographs alone.
#ifndef ORL_EVAL_ADAPT_H
#define ORL_EVAL_ADAPT_H

#include "eval/choice.h"
#include "oriel/progress.h"

// Means over training photographs, each rendered without itself.
struct orl_adapt_row {
    const struct orl_method *method;
    double psnr_db, ssim;
};
enum { ORL_ADAPT_METHODS_MAX = 32 };

struct orl_adapt_params {
    size_t views;    // photographs to compare with, at most, evenly chosen
    int size_divide; // at 1/n of their size
    double budget_s; // tuning and trimming end after this time; the methods are always compared
    const struct orl_progress *progress;
};

struct orl_adapt {
    struct orl_adapt_row rows[ORL_ADAPT_METHODS_MAX]; // methods that can draw the scene
    size_t row_count, chosen; // chosen: index of the row
    double tuned_db, tuned_ssim; // means of the chosen method with the options that were found
    bool complete;            // false: the time ran out
};

// The index of the row to choose: the method that no other beats in PSNR or in SSIM. Where the two
// disagree, the one of the least sum of ranks; of those, that of the greatest PSNR.
size_t orl_adapt_choose(const struct orl_adapt_row *rows, size_t count);

// Compares all methods. Of the best one, tries for each option the values that other methods have,
// keeps what is better (verdict.h), then tunes its numbers (tune.h), finds which of the renderer's settings save
// memory or time without a loss that counts (trim.h), and stores all of this in scene.json, where
// every command finds them. ORL_ERR_DATA: fewer than three training photographs.
enum orl_result orl_adapt_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                              const struct orl_adapt_params *params,
                              struct orl_adapt *adapt) ORL_CHECK_RESULT;

#endif
