#include "eval/adapt.h"

#include <string.h>

#include "core/process.h"
#include "eval/judges.h"
#include "eval/trim.h"
#include "eval/tune.h"
#include "scene/tuned_settings.h"

// Of the time that is left after the methods are compared, tuning may take this share.
static const double tune_share = 0.7;
// Settings may lose so much, which no one sees; tune.h's least gain is half of it.
static const double tolerance_db = 0.02, gain_db = 0.01;

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

// Measures one method. A method that cannot draw the scene, as one that needs a mesh, has no row.
static enum orl_result add_method(const struct orl_log *log, struct orl_renderer *renderer,
                                  const struct orl_judges *targets,
                                  const struct orl_method *method, struct orl_adapt *adapt)
{
    struct orl_adapt_row row = {.method = method};
    struct orl_render_params render;
    enum orl_result result =
        orl_render_params_tuned(log, method, targets->scene, &render);
    for (size_t i = 0; result == ORL_OK && i < targets->count; i++) {
        struct orl_metrics m;
        result = orl_judges_compare(log, renderer, targets, i, &render, NULL, false, &m);
        row.psnr_db += m.psnr_db / (double)targets->count;
        row.ssim += m.ssim / (double)targets->count;
    }
    if (result == ORL_OK)
        adapt->rows[adapt->row_count++] = row;
    return result == ORL_ERR_MEMORY || result == ORL_ERR_GPU ? result : ORL_OK;
}

static enum orl_result compare_methods(struct orl_gpu *gpu, const struct orl_scene *scene,
                                       struct orl_renderer *renderer,
                                       const struct orl_adapt_params *params,
                                       struct orl_adapt *adapt)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct orl_judges targets;
    size_t count = 0, done = 0;
    while (count < ORL_ADAPT_METHODS_MAX && orl_methods[count].name)
        count++;
    enum orl_result result =
        orl_judges_load(log, scene, params->views, params->size_divide, &targets);
    for (; result == ORL_OK && done < count; done++) {
        orl_progress_report(params->progress, "methods", (double)done, (double)count,
                            orl_methods[done].name);
        result = orl_progress_cancelled(params->progress)
                     ? ORL_ERR_CANCELLED
                     : add_method(log, renderer, &targets, &orl_methods[done], adapt);
    }
    orl_judges_finish(&targets);
    if (result == ORL_OK && !adapt->row_count)
        result = orl_fail(log, ORL_ERR_DATA, "%s: no method can draw this scene", scene->dir);
    adapt->chosen = orl_adapt_choose(adapt->rows, adapt->row_count);
    return result;
}

static enum orl_result tune(struct orl_gpu *gpu, const struct orl_scene *scene,
                            struct orl_renderer *renderer, const struct orl_adapt_params *params,
                            double budget_s, struct orl_choice *choice, struct orl_adapt *adapt)
{
    struct orl_tune tune;
    const struct orl_tune_params tuning = {
        .method = choice->method->name, .start = &choice->params,
        .size_divide = params->size_divide, .views = params->views, .gain_db = gain_db,
        .budget_s = budget_s, .progress = params->progress};
    enum orl_result result = orl_tune_run(gpu, renderer, scene, &tuning, &tune);
    if (result != ORL_OK)
        return result;
    choice->params = tune.best;
    adapt->tuned_db = tune.best_db;
    adapt->complete = tune.complete;
    orl_tune_finish(&tune);
    return ORL_OK;
}

static enum orl_result store(const struct orl_log *log, const struct orl_scene *scene,
                             const struct orl_choice *choice,
                             struct orl_scene_defaults defaults)
{
    json_t *record = json_pack("{s:o}", "settings",
                               orl_choice_settings(choice->method, &choice->params, false));
    defaults.method = (char *)choice->method->name;
    enum orl_result result = orl_tuned_write(log, scene->dir, choice->method->name, record);
    return result == ORL_OK ? orl_defaults_write(log, scene->dir, &defaults) : result;
}

static enum orl_result trim(struct orl_gpu *gpu, const struct orl_scene *scene,
                            const struct orl_adapt_params *params, double budget_s,
                            const struct orl_choice *choice, struct orl_adapt *adapt)
{
    struct orl_trim trim;
    const struct orl_trim_params trimming = {
        .start = choice, .tolerance_db = tolerance_db, .worst_db = 5 * tolerance_db,
        .views = params->views, .size_divide = params->size_divide, .budget_s = budget_s,
        .settings_only = true, .progress = params->progress};
    enum orl_result result = orl_trim_run(gpu, scene, &trimming, &trim);
    if (result != ORL_OK)
        return result;
    adapt->complete = adapt->complete && trim.complete;
    result = store(orl_gpu_log(gpu), scene, &trim.choice, trim.defaults);
    orl_trim_finish(&trim);
    return result;
}

enum orl_result orl_adapt_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                              const struct orl_adapt_params *params, struct orl_adapt *adapt)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct orl_renderer *renderer = NULL;
    struct orl_choice choice = {0};
    double start = orl_time_s();
    memset(adapt, 0, sizeof *adapt);
    enum orl_result result = orl_renderer_create(gpu, scene, NULL, &renderer);
    if (result == ORL_OK)
        result = compare_methods(gpu, scene, renderer, params, adapt);
    choice.method = adapt->rows[adapt->chosen].method;
    if (result == ORL_OK)
        result = orl_render_params_tuned(log, choice.method, scene, &choice.params);
    double left = params->budget_s - (orl_time_s() - start);
    if (result == ORL_OK && left > 0)
        result = tune(gpu, scene, renderer, params, tune_share * left, &choice, adapt);
    orl_renderer_destroy(&renderer);
    if (result == ORL_OK) // kept even if there is no time for more
        result = store(log, scene, &choice, scene->defaults);
    left = params->budget_s - (orl_time_s() - start);
    if (result == ORL_OK && left > 0)
        result = trim(gpu, scene, params, left, &choice, adapt);
    return result;
}
