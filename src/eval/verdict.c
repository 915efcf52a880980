#include "eval/verdict.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

// The judge of the k-th photograph of a verdict: every other one, then those between.
static size_t judge_of(size_t k, size_t judges)
{
    size_t half = (judges + 1) / 2;
    return k < half ? 2 * k : 2 * (k - half) + 1;
}

static void set_means(struct orl_verdict *verdict)
{
    double n = (double)verdict->count;
    verdict->psnr_db = verdict->ssim = 0;
    for (size_t i = 0; i < verdict->count; i++) {
        verdict->psnr_db += verdict->views[i][0] / n;
        verdict->ssim += verdict->views[i][1] / n;
    }
}

enum orl_result orl_verdict_extend(const struct orl_log *log, struct orl_renderer *renderer,
                                   const struct orl_judges *judges,
                                   const struct orl_render_params *render,
                                   const struct orl_progress *progress, size_t count,
                                   struct orl_verdict *verdict)
{
    enum orl_result result = ORL_OK;
    if (!verdict->views)
        verdict->views = orl_array(log, judges->count, sizeof *verdict->views);
    if (!verdict->views)
        result = ORL_ERR_MEMORY;
    while (result == ORL_OK && verdict->count < count) {
        struct orl_metrics m = {0};
        size_t judge = judge_of(verdict->count, judges->count);
        result = orl_progress_cancelled(progress)
                     ? ORL_ERR_CANCELLED
                     : orl_judges_compare(log, renderer, judges, judge, render, NULL, true, &m);
        verdict->views[verdict->count][0] = m.psnr_db;
        verdict->views[verdict->count][1] = m.ssim;
        verdict->count += result == ORL_OK;
    }
    set_means(verdict);
    if (result != ORL_OK)
        orl_verdict_finish(verdict);
    return result;
}

enum orl_result orl_verdict_measure(const struct orl_log *log, struct orl_renderer *renderer,
                                    const struct orl_judges *judges,
                                    const struct orl_render_params *render,
                                    const struct orl_progress *progress,
                                    struct orl_verdict *verdict)
{
    *verdict = (struct orl_verdict){0};
    return orl_verdict_extend(log, renderer, judges, render, progress, judges->count, verdict);
}

void orl_verdict_finish(struct orl_verdict *verdict)
{
    free(verdict->views);
    memset(verdict, 0, sizeof *verdict);
}

// Both figures of a photograph as one, in dB.
static double decibels(const double view[2])
{
    static const double least = 1e-6; // 60 dB, for pictures that are the same
    return (view[0] - 10 * log10(fmax(1 - view[1], least))) / 2;
}

double orl_verdict_gain_db(const struct orl_verdict *now, const struct orl_verdict *before)
{
    double sum = 0;
    for (size_t i = 0; i < now->count; i++)
        sum += decibels(now->views[i]) - decibels(before->views[i]);
    return now->count ? sum / (double)now->count : 0;
}

bool orl_verdict_better(const struct orl_verdict *now, const struct orl_verdict *before,
                        double gain_db)
{
    double n = (double)now->count, mean = orl_verdict_gain_db(now, before), square = 0;
    if (now->psnr_db < before->psnr_db || now->ssim < before->ssim)
        return false;
    for (size_t i = 0; i < now->count; i++) {
        double gain = decibels(now->views[i]) - decibels(before->views[i]);
        square += (gain - mean) * (gain - mean) / n;
    }
    double error = n > 1 ? sqrt(square / (n - 1)) : 0;
    return mean >= gain_db && mean > error;
}

bool orl_verdict_clearly_better(const struct orl_verdict *now, const struct orl_verdict *before,
                                double gain_db)
{
    size_t gaining = 0;
    for (size_t i = 0; i < now->count; i++)
        gaining += decibels(now->views[i]) > decibels(before->views[i]);
    return 2 * gaining > now->count && orl_verdict_better(now, before, gain_db);
}
