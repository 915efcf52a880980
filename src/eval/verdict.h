// What training photographs say of one setting, and whether another setting is better.
#ifndef ORL_EVAL_VERDICT_H
#define ORL_EVAL_VERDICT_H

#include "eval/judges.h"

struct orl_verdict {
    double (*views)[2];   // owned: PSNR in dB and SSIM of each photograph: every other judge, then
                          // those between, so that the first half lies all around the scene
    size_t count;
    double psnr_db, ssim; // means
};

// Renders the views of all judges, each without its own photograph. `verdict` is empty or finished
// before. ORL_ERR_CANCELLED: `progress` (NULL: none) asks for it.
enum orl_result orl_verdict_measure(const struct orl_log *log, struct orl_renderer *renderer,
                                    const struct orl_judges *judges,
                                    const struct orl_render_params *render,
                                    const struct orl_progress *progress,
                                    struct orl_verdict *verdict) ORL_CHECK_RESULT;
// The same for the views from verdict->count on, until there are `count`. The first call has an
// empty verdict.
enum orl_result orl_verdict_extend(const struct orl_log *log, struct orl_renderer *renderer,
                                   const struct orl_judges *judges,
                                   const struct orl_render_params *render,
                                   const struct orl_progress *progress, size_t count,
                                   struct orl_verdict *verdict) ORL_CHECK_RESULT;
void orl_verdict_finish(struct orl_verdict *verdict);

// The mean gain of `now` over `before`, which may have more photographs: of the photographs of
// both, the mean of the gains of PSNR and of SSIM in dB (-10 log10(1 - SSIM)).
double orl_verdict_gain_db(const struct orl_verdict *now, const struct orl_verdict *before);
// True when `now` is better than `before`, of the same judges: neither mean is worse, and the gain,
// the mean of those of PSNR and of SSIM in dB (-10 log10(1 - SSIM)), is at least `gain_db` and
// larger than its standard error over the photographs. What a few photographs gain by chance is
// refused, since it would not hold for others.
bool orl_verdict_better(const struct orl_verdict *now, const struct orl_verdict *before,
                        double gain_db);
// True when it is better, and by itself on more than half of the photographs: what one photograph
// gains alone does not decide for all.
bool orl_verdict_clearly_better(const struct orl_verdict *now, const struct orl_verdict *before,
                                double gain_db);

#endif
