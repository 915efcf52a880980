// Validation photographs: those for training that are compared with renderings from the others, by
// which tune and trim decide without looking at a held-out photograph.
#ifndef ORL_EVAL_VALIDATION_H
#define ORL_EVAL_VALIDATION_H

#include "eval/heldout.h"
#include "oriel/progress.h"

// Training photographs that a scene needs, to render one from two others.
enum { ORL_VALIDATION_TRAIN_MIN = 3 };

struct orl_validation {
    struct orl_scene scene; // shares all but `photos`, which are owned: their gains are those for validation
    struct orl_heldout *views; // owned: the photographs, in ascending order when they are loaded
    size_t count;
    bool *skip; // owned: photographs that the current rendering does without
};

// Counts the training photographs. ORL_ERR_DATA: fewer than ORL_VALIDATION_TRAIN_MIN.
enum orl_result orl_validation_check(const struct orl_log *log, const struct orl_scene *scene,
                                     size_t *train) ORL_CHECK_RESULT;
// Loads at most `most` training photographs, evenly chosen (0: all), at 1/divide of their size.
// Where the exposure of held-out photographs cannot be guessed, that of training photographs is not
// used, either: a rendering that knows it would gain what no held-out photograph confirms.
// ORL_ERR_DATA: fewer than ORL_VALIDATION_TRAIN_MIN photographs are for training.
enum orl_result orl_validation_load(const struct orl_log *log, const struct orl_scene *scene,
                                    size_t most, int divide,
                                    struct orl_validation *validation) ORL_CHECK_RESULT;
void orl_validation_finish(struct orl_validation *validation);
// How far apart two photographs are: the distance of their centres as a share of the distance to
// what they see, and the angle between their directions, added up.
double orl_validation_apart(const struct orl_scene *scene, size_t a, size_t b);
// The training photograph nearest to another one, but not `but`, of those that `removed` marks or, unless is_removed, does not
// mark (NULL: it marks none). photo_count: there is none.
size_t orl_validation_nearest(const struct orl_scene *scene, size_t photo, const bool *removed, bool is_removed,
                              size_t but);
// True when photograph b stands where a stands and looks where a looks, as repeated photographs
// and exposure series do. Rendering the view of one from the other would tell nothing.
bool orl_validation_same_place(const struct orl_scene *scene, size_t a, size_t b);
// Marks in `skip` what a rendering of the photograph's view does without: that photograph, those from
// the same place (unless no other is left) and those that `removed` marks (NULL: none).
void orl_validation_leave_out(const struct orl_scene *scene, size_t photo, const bool *removed,
                              bool *skip);

// --- what they say of one setting, and whether another one is better ---

struct orl_score {
    double (*views)[2];   // owned: PSNR in dB and SSIM of each photograph
    size_t count;         // of the photographs that are measured, the first of the validation
    double psnr_db, ssim; // means over them
};

// Renders the views of those of the first `count` validation photographs that `score` lacks, each without
// what orl_validation_leave_out marks, and compares them. `score` is empty at first, and after a failure.
// The renderer's scene must have the photographs of the validation's scene, in the same order.
// ORL_ERR_CANCELLED: `progress` (NULL: none) asks for it.
enum orl_result orl_score_measure(const struct orl_log *log, struct orl_renderer *renderer,
                                  const struct orl_validation *validation, size_t count,
                                  const struct orl_render_params *render, const bool *removed,
                                  const struct orl_progress *progress,
                                  struct orl_score *score) ORL_CHECK_RESULT;
void orl_score_finish(struct orl_score *score);

// What a score loses against another one, over the photographs that both have.
struct orl_score_loss {
    double psnr_db, ssim; // means
    double worst_db;      // the most that one photograph loses
};
struct orl_score_loss orl_score_loss(const struct orl_score *before, const struct orl_score *now);

// True when `now` is better than `before`: neither mean is worse, and the gain, the mean of those of PSNR
// and of SSIM in dB (-10 log10(1 - SSIM)), is at least `gain_db` and larger than its standard error over
// the photographs. What a few photographs gain by chance is refused, since it would not hold for others.
bool orl_score_better(const struct orl_score *now, const struct orl_score *before,
                      double gain_db);

#endif
