#include "eval/adapt.h"

#include <stdio.h>
#include <string.h>

#include "core/process.h"
#include "eval/trim.h"
#include "eval/tune.h"
#include "eval/verdict.h"
#include "scene/tuned_settings.h"

// Of the time that is left after the methods are compared, tuning may take this share.
static const double tune_share = 0.7;
// Settings may lose so much, which no one sees; a gain must be at least half of it.
static const double tolerance_db = 0.02, tolerance_ssim = 0.002, gain_db = 0.01;

static size_t ranks_above(const struct orl_adapt_row *rows, size_t count, size_t row)
{
    size_t sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += rows[i].psnr_db > rows[row].psnr_db;
        sum += rows[i].ssim > rows[row].ssim;
    }
    return sum;
}

size_t orl_adapt_choose(const struct orl_adapt_row *rows, size_t count)
{
    size_t best = 0;
    for (size_t i = 1; i < count; i++) {
        size_t above = ranks_above(rows, count, i), least = ranks_above(rows, count, best);
        if (above < least || (above == least && rows[i].psnr_db > rows[best].psnr_db))
            best = i;
    }
    return best;
}

// --- the methods ---

struct job {
    struct orl_gpu *gpu;
    const struct orl_log *log;
    const struct orl_scene *scene;
    const struct orl_adapt_params *params;
    struct orl_adapt *adapt;
    struct orl_renderer *renderer;
    struct orl_judges judges;
    struct orl_choice choice;   // the best so far
    struct orl_verdict verdict; // of it
    double start_s;
};

// The time that is left for all but the comparison of methods.
static double left_s(const struct job *job)
{
    return job->params->budget_s - (orl_time_s() - job->start_s);
}

// Measures one method. A method that cannot draw the scene, as one that needs a mesh, has no row.
static enum orl_result add_method(struct job *job, const struct orl_method *method)
{
    struct orl_adapt *adapt = job->adapt;
    struct orl_render_params render;
    struct orl_verdict verdict = {0};
    enum orl_result result = orl_render_params_tuned(job->log, method, job->scene, &render);
    if (result == ORL_OK)
        result = orl_verdict_measure(job->log, job->renderer, &job->judges, &render,
                                     job->params->progress, &verdict);
    if (result == ORL_OK)
        adapt->rows[adapt->row_count++] =
            (struct orl_adapt_row){method, verdict.psnr_db, verdict.ssim};
    orl_verdict_finish(&verdict);
    bool fatal = result == ORL_ERR_MEMORY || result == ORL_ERR_GPU || result == ORL_ERR_CANCELLED;
    return fatal ? result : ORL_OK;
}

static enum orl_result compare_methods(struct job *job)
{
    struct orl_adapt *adapt = job->adapt;
    size_t count = 0;
    enum orl_result result = ORL_OK;
    while (count < ORL_ADAPT_METHODS_MAX && orl_methods[count].name)
        count++;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        orl_progress_report(job->params->progress, "methods", (double)i, (double)count,
                            orl_methods[i].name);
        result = add_method(job, &orl_methods[i]);
    }
    if (result == ORL_OK && !adapt->row_count)
        result = orl_fail(job->log, ORL_ERR_DATA, "%s: no method can draw this scene",
                          job->scene->dir);
    adapt->chosen = orl_adapt_choose(adapt->rows, adapt->row_count);
    job->choice.method = adapt->rows[adapt->chosen].method;
    if (result == ORL_OK)
        result = orl_render_params_tuned(job->log, job->choice.method, job->scene,
                                         &job->choice.params);
    if (result == ORL_OK)
        result = orl_verdict_measure(job->log, job->renderer, &job->judges, &job->choice.params,
                                     job->params->progress, &job->verdict);
    return result;
}

// --- what other methods do ---

// Tries an option's value; keeps it if it is better. Values that do not go with the other choices
// change nothing.
static enum orl_result try_value(struct job *job, const struct orl_render_option *option,
                                 const char *value)
{
    char assignment[2 * ORL_OPTION_NAME_BYTES + 2], own[ORL_OPTION_NAME_BYTES];
    struct orl_render_params render = job->choice.params;
    struct orl_verdict verdict = {0};
    orl_render_option_print(option, &render, own, sizeof own);
    snprintf(assignment, sizeof assignment, "%s=%s", option->key, value);
    if (strcmp(own, value) == 0 || orl_render_params_set(NULL, &render, assignment) != ORL_OK)
        return ORL_OK;
    enum orl_result result = orl_verdict_measure(job->log, job->renderer, &job->judges, &render,
                                                 job->params->progress, &verdict);
    if (result == ORL_OK && orl_verdict_better(&verdict, &job->verdict, gain_db)) {
        orl_logf(job->log, ORL_LOG_INFO, "%s: %.2f dB, SSIM %.4f", assignment, verdict.psnr_db,
                 verdict.ssim);
        orl_verdict_finish(&job->verdict);
        job->verdict = verdict;
        job->choice.params = render;
        return ORL_OK;
    }
    orl_verdict_finish(&verdict);
    return result == ORL_ERR_ARGUMENT || result == ORL_ERR_NOT_FOUND ? ORL_OK : result;
}

// Tries the values that other methods have for an option, each of them once.
static enum orl_result borrow_option(struct job *job, const struct orl_render_option *option)
{
    char value[ORL_OPTION_NAME_BYTES], before[ORL_OPTION_NAME_BYTES];
    enum orl_result result = ORL_OK;
    for (const struct orl_method *m = orl_methods; result == ORL_OK && m->name; m++) {
        bool known = false;
        orl_render_option_print(option, &m->params, value, sizeof value);
        for (const struct orl_method *other = orl_methods; other < m; other++) {
            orl_render_option_print(option, &other->params, before, sizeof before);
            known = known || strcmp(value, before) == 0;
        }
        if (!known && left_s(job) > 0)
            result = try_value(job, option, value);
    }
    return result;
}

static enum orl_result borrow(struct job *job)
{
    enum orl_result result = ORL_OK;
    size_t count = 0, done = 0;
    while (orl_render_options[count].key)
        count++;
    for (; result == ORL_OK && done < count; done++) {
        const struct orl_render_option *option = &orl_render_options[done];
        orl_progress_report(job->params->progress, "options", (double)done, (double)count,
                            option->key);
        // Another proxy or painter would be another method.
        if (strcmp(option->key, "proxy") != 0 && strcmp(option->key, "paint") != 0)
            result = borrow_option(job, option);
    }
    return result;
}

// --- numbers, and what can be saved ---

static enum orl_result tune(struct job *job)
{
    struct orl_tune tune;
    const struct orl_tune_params tuning = {
        .method = job->choice.method->name, .start = &job->choice.params,
        .size_divide = job->params->size_divide, .views = job->params->views, .gain_db = gain_db,
        .budget_s = tune_share * left_s(job), .progress = job->params->progress};
    enum orl_result result = orl_tune_run(job->gpu, job->renderer, job->scene, &tuning, &tune);
    if (result != ORL_OK)
        return result;
    job->choice.params = tune.best;
    job->adapt->tuned_db = tune.best_db;
    job->adapt->tuned_ssim = tune.best_ssim;
    job->adapt->complete = tune.complete;
    orl_tune_finish(&tune);
    return ORL_OK;
}

static enum orl_result store(const struct orl_log *log, const struct orl_scene *scene,
                             const struct orl_choice *choice,
                             struct orl_scene_defaults defaults)
{
    json_t *record = json_pack("{s:o}", "settings",
                               orl_choice_settings(choice->method, &choice->params));
    defaults.method = (char *)choice->method->name;
    enum orl_result result = orl_tuned_write(log, scene->dir, choice->method->name, record);
    return result == ORL_OK ? orl_defaults_write(log, scene->dir, &defaults) : result;
}

static enum orl_result trim(struct job *job)
{
    struct orl_trim trim;
    const struct orl_trim_params trimming = {
        .start = &job->choice, .tolerance_db = tolerance_db, .tolerance_ssim = tolerance_ssim,
        .worst_db = 5 * tolerance_db, .views = job->params->views, .size_divide = job->params->size_divide,
        .budget_s = left_s(job), .settings_only = true, .progress = job->params->progress};
    enum orl_result result = orl_trim_run(job->gpu, job->scene, &trimming, &trim);
    if (result != ORL_OK)
        return result;
    job->adapt->complete = job->adapt->complete && trim.complete;
    result = store(job->log, job->scene, &trim.choice, trim.defaults);
    orl_trim_finish(&trim);
    return result;
}

enum orl_result orl_adapt_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                              const struct orl_adapt_params *params, struct orl_adapt *adapt)
{
    struct job job = {.gpu = gpu, .log = orl_gpu_log(gpu), .scene = scene, .params = params,
                      .adapt = adapt, .start_s = orl_time_s()};
    memset(adapt, 0, sizeof *adapt);
    enum orl_result result = orl_renderer_create(gpu, scene, NULL, &job.renderer);
    if (result == ORL_OK)
        result = orl_judges_load(job.log, scene, params->views, params->size_divide, &job.judges);
    if (result == ORL_OK)
        result = compare_methods(&job);
    if (result == ORL_OK && left_s(&job) > 0)
        result = borrow(&job);
    adapt->tuned_db = job.verdict.psnr_db;
    adapt->tuned_ssim = job.verdict.ssim;
    if (result == ORL_OK && left_s(&job) > 0)
        result = tune(&job);
    orl_renderer_destroy(&job.renderer);
    orl_judges_finish(&job.judges);
    orl_verdict_finish(&job.verdict);
    if (result == ORL_OK) // kept even if there is no time for more
        result = store(job.log, scene, &job.choice, scene->defaults);
    if (result == ORL_OK && left_s(&job) > 0)
        result = trim(&job);
    return result;
}
