// Chooses how a scene is drawn: the method, its options and the renderer's settings, from training
// photographs alone.
#ifndef ORL_EVAL_ADAPT_H
#define ORL_EVAL_ADAPT_H

#include "eval/search.h"

enum { ORL_ADAPT_METHODS_MAX = 32 };

struct orl_adapt_params {
    bool search;     // all methods and options; else the few steps that measured well, with so few
                     // renderings that prepare can take them by default
    size_t views;    // photographs to compare with, at most, evenly chosen
    int size_divide; // at 1/n of their size
    double budget_s; // of the search: tuning and trimming end after this time; the methods are
                     // always compared
    const struct orl_progress *progress;
};

struct orl_adapt {
    // Of the search: the methods that can draw the scene, and the index of the chosen one.
    struct orl_trial rows[ORL_ADAPT_METHODS_MAX];
    size_t row_count, chosen;
    struct orl_choice choice; // the method, with the options that were found
    struct orl_scene_defaults defaults; // and the rest of what scene.json states; texts are not
                                        // owned
    size_t views;                // photographs that were compared with
    double plain_db, plain_ssim; // means of the chosen method of the search, or of the scene's
    double tuned_db, tuned_ssim; // means of the choice
    bool complete;               // false: the time, or the number of renderings, ran out
};

enum { ORL_ADAPT_VIEWS = 6 }; // usual number of photographs to compare with

// How many views the steps may render, first those of the scene as it is: so many that they take
// less than a tenth of the processor time of prepare. It depends on the number and the size of the
// training photographs alone, so that the same scene gives the same result on any machine.
size_t orl_adapt_renderings(const struct orl_scene *scene);

// The index of the row to choose: the method that no other beats in PSNR or in SSIM. Where the two
// disagree, the one of the least sum of ranks; of those, that of the greatest PSNR.
size_t orl_adapt_choose(const struct orl_trial *rows, size_t count);

// Steps: tries a few changes of the scene's method that gained on scenes that were measured, and
// keeps what is clearly better (score.h). Search: compares all methods. Of the best one, tries
// for each option the values that other methods have, keeps what is better, then tunes its numbers
// (search.h), and finds which of the renderer's settings save memory or time without a loss that
// counts (trim.h). ORL_ERR_DATA: fewer than ORL_VALIDATION_TRAIN_MIN training photographs.
enum orl_result orl_adapt_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                              const struct orl_adapt_params *params,
                              struct orl_adapt *adapt) ORL_CHECK_RESULT;

// "tuned" and "render" of scene.json, as an object with both. A new reference; NULL: no memory.
json_t *orl_adapt_json(const struct orl_adapt *adapt);
// Stores them in scene.json in the folder `dir`, where every command finds them.
enum orl_result orl_adapt_store(const struct orl_log *log, const char *dir,
                                const struct orl_adapt *adapt) ORL_CHECK_RESULT;

#endif
