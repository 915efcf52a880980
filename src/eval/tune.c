#include "eval/tune.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/process.h"
#include "eval/score.h"

enum { ROUNDS_MAX = 8 };

struct job {
    const struct orl_log *log;
    struct orl_renderer *renderer;
    const struct orl_scene *scene;
    const struct orl_tune_params *params;
    struct orl_tune *tune;
    struct orl_validation targets;
    struct orl_score best; // of tune->best
    double start_s;
    double done, total; // number of renderings, for the progress report
};

// --- one trial ---

static enum orl_result run_trial(struct job *job, const struct orl_render_params *render,
                                 struct orl_tune_trial *trial, struct orl_score *score)
{
    orl_progress_report(job->params->progress, "tune", job->done, job->total, trial->key);
    enum orl_result result = orl_score_measure(job->log, job->renderer, &job->targets, render,
                                               job->params->progress, score);
    job->done += (double)job->targets.count;
    trial->psnr_db = score->psnr_db;
    trial->ssim = score->ssim;
    return result;
}

// Takes the score over as that of the best values.
static void take(struct job *job, struct orl_score *score)
{
    orl_score_finish(&job->best);
    job->best = *score;
    memset(score, 0, sizeof *score);
    job->tune->best_db = job->best.psnr_db;
    job->tune->best_ssim = job->best.ssim;
}

static enum orl_result note_trial(struct job *job, const struct orl_tune_trial *trial)
{
    struct orl_tune *tune = job->tune;
    enum orl_result result = orl_grow(job->log, (void **)&tune->trials, &tune->trial_capacity,
                                      tune->trial_count + 1, sizeof *tune->trials);
    if (result != ORL_OK)
        return result;
    tune->trials[tune->trial_count++] = *trial;
    if (job->params->on_trial)
        job->params->on_trial(job->params->priv, trial);
    return ORL_OK;
}

// --- the search ---

static float *field(struct orl_render_params *params, const struct orl_render_option *option)
{
    return (float *)((char *)params + option->offset);
}

static bool out_of_time(const struct job *job)
{
    return job->params->budget_s > 0 && orl_time_s() - job->start_s >= job->params->budget_s;
}

// Tries one value. `kept`: the result is better; `same`: the value has no effect at all.
static enum orl_result try_value(struct job *job, const struct orl_render_option *option,
                                 double value, bool *kept, bool *same)
{
    struct orl_tune *tune = job->tune;
    struct orl_render_params render = tune->best;
    struct orl_tune_trial trial = {.key = option->key, .value = value};
    *field(&render, option) = (float)value;
    struct orl_score score = {0};
    enum orl_result result = run_trial(job, &render, &trial, &score);
    if (result != ORL_OK)
        return result;
    *kept = trial.kept = orl_score_better(&score, &job->best, job->params->gain_db);
    *same = trial.psnr_db == tune->best_db && trial.ssim == tune->best_ssim;
    if (trial.kept) {
        tune->best = render;
        take(job, &score);
    }
    orl_score_finish(&score);
    return note_trial(job, &trial);
}

// The next of the option's values to try beyond `from`; NAN: none.
static double next_try(const struct orl_render_option *option, double from, int direction)
{
    double next = NAN;
    for (int i = 0; i < option->try_count; i++) {
        double value = option->tries[i];
        // The stored value is a float, so values are compared with a tolerance.
        if ((value - from) * direction <= 1e-6 * fabs(from))
            continue;
        if (isnan(next) || (next - value) * direction > 0)
            next = value;
    }
    return next;
}

static enum orl_result tune_option(struct job *job, const struct orl_render_option *option,
                                   bool *better)
{
    enum orl_result result = ORL_OK;
    bool moved = false;
    for (int direction = 1; direction >= -1 && !moved; direction -= 2) {
        bool kept = true, same = false;
        while (result == ORL_OK && kept && !out_of_time(job)) {
            double value = next_try(option, (double)*field(&job->tune->best, option), direction);
            if (isnan(value))
                break;
            result = try_value(job, option, value, &kept, &same);
            moved = moved || (result == ORL_OK && kept);
        }
        if (result != ORL_OK || same) // an option without effect in these views
            break;
    }
    *better = *better || moved;
    return result;
}

static bool is_chosen(const struct job *job, const struct orl_render_option *option)
{
    const struct orl_names *keys = job->params->keys;
    if (option->try_count == 0 || !orl_render_option_read(option, job->params->start))
        return false;
    return !keys || !keys->count || orl_names_contain(keys, option->key);
}

static enum orl_result check_keys(const struct job *job)
{
    const struct orl_names *keys = job->params->keys;
    for (size_t i = 0; keys && i < keys->count; i++) {
        const struct orl_render_option *option = orl_render_option_find(keys->items[i]);
        if (!option || option->try_count == 0)
            return orl_fail(job->log, ORL_ERR_ARGUMENT, "%s: not an option that can be tuned",
                            keys->items[i]);
    }
    return ORL_OK;
}

static enum orl_result search(struct job *job)
{
    struct orl_tune *tune = job->tune;
    struct orl_tune_trial start = {.kept = true};
    struct orl_score score = {0};
    enum orl_result result = run_trial(job, &tune->best, &start, &score);
    if (result == ORL_OK) {
        take(job, &score);
        tune->start_db = tune->best_db;
        result = note_trial(job, &start);
    }
    bool better = true;
    for (int round = 0; result == ORL_OK && better && round < ROUNDS_MAX && !out_of_time(job);
         round++) {
        better = false;
        for (const struct orl_render_option *o = orl_render_options; result == ORL_OK && o->key; o++)
            if (is_chosen(job, o))
                result = tune_option(job, o, &better);
    }
    tune->complete = !out_of_time(job);
    return result;
}

enum orl_result orl_tune_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                             const struct orl_scene *scene, const struct orl_tune_params *params,
                             struct orl_tune *tune)
{
    struct job job = {.log = orl_gpu_log(gpu), .renderer = renderer, .scene = scene,
                      .params = params, .tune = tune, .start_s = orl_time_s()};
    memset(tune, 0, sizeof *tune);
    ORL_REQUIRE(job.log, params->size_divide >= 1 && params->size_divide <= 16);
    tune->best = *params->start;
    enum orl_result result = check_keys(&job);
    if (result == ORL_OK)
        result = orl_validation_load(job.log, scene, params->views, params->size_divide,
                                     &job.targets);
    tune->views = job.targets.count;
    for (const struct orl_render_option *o = orl_render_options; o->key; o++)
        // An estimate, for the progress report.
        job.total += is_chosen(&job, o) ? 3.0 * (double)job.targets.count : 0;
    if (result == ORL_OK)
        result = search(&job);
    if (result == ORL_OK)
        orl_progress_report(params->progress, "tune", 1, 1, NULL);
    orl_validation_finish(&job.targets);
    orl_score_finish(&job.best);
    if (result != ORL_OK)
        orl_tune_finish(tune);
    return result;
}

void orl_tune_finish(struct orl_tune *tune)
{
    if (!tune)
        return;
    free(tune->trials);
    memset(tune, 0, sizeof *tune);
}
