// What training photographs say of one setting, and whether another setting is better.
#ifndef ORL_EVAL_SCORE_H
#define ORL_EVAL_SCORE_H

#include "eval/validation.h"

struct orl_score {
    double (*views)[2];   // owned: PSNR in dB and SSIM of each photograph
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
void orl_score_finish(struct orl_score *score);

// True when `now` is better than `before`, of the same photographs: neither mean is worse, and
// the gain, the mean of those of PSNR and of SSIM in dB (-10 log10(1 - SSIM)), is at least `gain_db` and
// larger than its standard error over the photographs. What a few photographs gain by chance is
// refused, since it would not hold for others.
bool orl_score_better(const struct orl_score *now, const struct orl_score *before,
                      double gain_db);
#endif
