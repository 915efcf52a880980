#include "eval/score.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

// The validation photograph that is the k-th of a score: every other one, then those between.
static size_t view_of(size_t k, size_t views)
{
    size_t half = (views + 1) / 2;
    return k < half ? 2 * k : 2 * (k - half) + 1;
}

static void set_means(struct orl_score *score)
{
    double n = (double)score->count;
    score->psnr_db = score->ssim = 0;
    for (size_t i = 0; i < score->count; i++) {
        score->psnr_db += score->views[i][0] / n;
        score->ssim += score->views[i][1] / n;
    }
}

enum orl_result orl_score_extend(const struct orl_log *log, struct orl_renderer *renderer,
                                 const struct orl_validation *validation,
                                 const struct orl_render_params *render,
                                 const struct orl_progress *progress, size_t count,
                                 struct orl_score *score)
{
    enum orl_result result = ORL_OK;
    if (!score->views)
        score->views = orl_array(log, validation->count, sizeof *score->views);
    if (!score->views)
        result = ORL_ERR_MEMORY;
    while (result == ORL_OK && score->count < count) {
        struct orl_metrics m = {0};
        size_t view = view_of(score->count, validation->count);
        result = orl_progress_cancelled(progress)
                     ? ORL_ERR_CANCELLED
                     : orl_validation_compare(log, renderer, validation, view, render, NULL, true,
                                              &m);
        score->views[score->count][0] = m.psnr_db;
        score->views[score->count][1] = m.ssim;
        score->count += result == ORL_OK;
    }
    set_means(score);
    if (result != ORL_OK)
        orl_score_finish(score);
    return result;
}

enum orl_result orl_score_measure(const struct orl_log *log, struct orl_renderer *renderer,
                                  const struct orl_validation *validation,
                                  const struct orl_render_params *render,
                                  const struct orl_progress *progress,
                                  struct orl_score *score)
{
    *score = (struct orl_score){0};
    return orl_score_extend(log, renderer, validation, render, progress, validation->count, score);
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

double orl_score_gain_db(const struct orl_score *now, const struct orl_score *before)
{
    double sum = 0;
    for (size_t i = 0; i < now->count; i++)
        sum += decibels(now->views[i]) - decibels(before->views[i]);
    return now->count ? sum / (double)now->count : 0;
}

bool orl_score_better(const struct orl_score *now, const struct orl_score *before,
                      double gain_db)
{
    double n = (double)now->count, mean = orl_score_gain_db(now, before), square = 0;
    if (now->psnr_db < before->psnr_db || now->ssim < before->ssim)
        return false;
    for (size_t i = 0; i < now->count; i++) {
        double gain = decibels(now->views[i]) - decibels(before->views[i]);
        square += (gain - mean) * (gain - mean) / n;
    }
    double error = n > 1 ? sqrt(square / (n - 1)) : 0;
    return mean >= gain_db && mean > error;
}

bool orl_score_clearly_better(const struct orl_score *now, const struct orl_score *before,
                              double gain_db)
{
    size_t gaining = 0;
    for (size_t i = 0; i < now->count; i++)
        gaining += decibels(now->views[i]) > decibels(before->views[i]);
    return 2 * gaining > now->count && orl_score_better(now, before, gain_db);
}
