// What training photographs say of one setting, and whether another setting is better.
#ifndef ORL_EVAL_SCORE_H
#define ORL_EVAL_SCORE_H

#include "eval/validation.h"

struct orl_score {
    double (*views)[2];   // owned: PSNR in dB and SSIM of each photograph: every other one, then
                          // those between, so that the first half lies all around the scene
    size_t count;
    double psnr_db, ssim; // means
};

// Renders the views of all validation photographs, each without its own photograph. `score` is empty
// or finished before. ORL_ERR_CANCELLED: `progress` (NULL: none) asks for it.
enum orl_result orl_score_measure(const struct orl_log *log, struct orl_renderer *renderer,
                                  const struct orl_validation *validation,
                                  const struct orl_render_params *render,
                                  const struct orl_progress *progress,
                                  struct orl_score *score) ORL_CHECK_RESULT;
// The same for the views from score->count on, until there are `count`. The first call has an
// empty score.
enum orl_result orl_score_extend(const struct orl_log *log, struct orl_renderer *renderer,
                                 const struct orl_validation *validation,
                                 const struct orl_render_params *render,
                                 const struct orl_progress *progress, size_t count,
                                 struct orl_score *score) ORL_CHECK_RESULT;
void orl_score_finish(struct orl_score *score);

// The mean gain of `now` over `before`, which may have more photographs: of the photographs of
// both, the mean of the gains of PSNR and of SSIM in dB (-10 log10(1 - SSIM)).
double orl_score_gain_db(const struct orl_score *now, const struct orl_score *before);
// True when `now` is better than `before`, of the same photographs: neither mean is worse, and
// the gain, the mean of those of PSNR and of SSIM in dB (-10 log10(1 - SSIM)), is at least `gain_db` and
// larger than its standard error over the photographs. What a few photographs gain by chance is
// refused, since it would not hold for others.
bool orl_score_better(const struct orl_score *now, const struct orl_score *before,
                      double gain_db);
// True when it is better, and by itself on more than half of the photographs: what one photograph
// gains alone does not decide for all.
bool orl_score_clearly_better(const struct orl_score *now, const struct orl_score *before,
                              double gain_db);

#endif
