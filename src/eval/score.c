#include "eval/score.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

static void set_means(struct orl_score *score)
{
    double n = (double)score->count;
    score->psnr_db = score->ssim = 0;
    for (size_t i = 0; i < score->count; i++) {
        score->psnr_db += score->views[i][0] / n;
        score->ssim += score->views[i][1] / n;
    }
}

enum orl_result orl_score_measure(const struct orl_log *log, struct orl_renderer *renderer,
                                  const struct orl_validation *validation,
                                  const struct orl_render_params *render,
                                  const struct orl_progress *progress,
                                  struct orl_score *score)
{
    *score = (struct orl_score){.views = orl_array(log, validation->count, sizeof *score->views)};
    enum orl_result result = score->views ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < validation->count; i++) {
        result = orl_progress_cancelled(progress)
                     ? ORL_ERR_CANCELLED
                     : orl_validation_compare(log, renderer, validation, i, render, NULL,
                                              &score->views[i][0], &score->views[i][1]);
        score->count += result == ORL_OK;
    }
    set_means(score);
    if (result != ORL_OK)
        orl_score_finish(score);
    return result;
}

void orl_score_finish(struct orl_score *score)
{
    free(score->views);
    memset(score, 0, sizeof *score);
}

// Both figures of a photograph as one, in dB.
static double decibels(const double view[2])
{
    static const double least = 1e-6; // 60 dB, for pictures that are the same
    return (view[0] - 10 * log10(fmax(1 - view[1], least))) / 2;
}

static double gain_of(const struct orl_score *now, const struct orl_score *before, size_t view)
{
    return decibels(now->views[view]) - decibels(before->views[view]);
}

bool orl_score_better(const struct orl_score *now, const struct orl_score *before,
                      double gain_db)
{
    double n = (double)now->count, mean = 0, square = 0;
    if (now->psnr_db < before->psnr_db || now->ssim < before->ssim)
        return false;
    for (size_t i = 0; i < now->count; i++)
        mean += gain_of(now, before, i) / n;
    for (size_t i = 0; i < now->count; i++)
        square += pow(gain_of(now, before, i) - mean, 2) / n;
    double error = n > 1 ? sqrt(square / (n - 1)) : 0;
    return mean >= gain_db && mean > error;
}
