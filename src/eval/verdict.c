#include "eval/verdict.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

enum orl_result orl_verdict_measure(const struct orl_log *log, struct orl_renderer *renderer,
                                    const struct orl_judges *judges,
                                    const struct orl_render_params *render,
                                    const struct orl_progress *progress,
                                    struct orl_verdict *verdict)
{
    *verdict = (struct orl_verdict){.count = judges->count};
    verdict->views = orl_array(log, judges->count, sizeof *verdict->views);
    enum orl_result result = verdict->views ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < judges->count; i++) {
        struct orl_metrics m = {0};
        result = orl_progress_cancelled(progress)
                     ? ORL_ERR_CANCELLED
                     : orl_judges_compare(log, renderer, judges, i, render, NULL, false, &m);
        verdict->views[i][0] = m.psnr_db;
        verdict->views[i][1] = m.ssim;
        verdict->psnr_db += m.psnr_db / (double)judges->count;
        verdict->ssim += m.ssim / (double)judges->count;
    }
    if (result != ORL_OK)
        orl_verdict_finish(verdict);
    return result;
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

bool orl_verdict_better(const struct orl_verdict *now, const struct orl_verdict *before,
                        double gain_db)
{
    double n = (double)now->count, mean = 0, square = 0;
    if (now->psnr_db < before->psnr_db || now->ssim < before->ssim)
        return false;
    for (size_t i = 0; i < now->count; i++) {
        double gain = decibels(now->views[i]) - decibels(before->views[i]);
        mean += gain / n;
        square += gain * gain / n;
    }
    double error = n > 1 ? sqrt(fmax(square - mean * mean, 0) / (n - 1)) : 0;
    return mean >= gain_db && mean > error;
}
