#include "eval/search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "core/memory.h"
#include "core/process.h"

enum { ROUNDS_MAX = 8 };

void orl_search_finish(struct orl_search *s)
{
    if (!s)
        return;
    orl_validation_finish(&s->validation);
    orl_score_finish(&s->score);
    free(s->trials);
    memset(s, 0, sizeof *s);
}

// True when no new trial may start.
static bool is_over(const struct orl_search *s)
{
    return s->params.budget_s > 0 && orl_time_s() - s->start_s >= s->params.budget_s;
}

// --- one trial ---

static enum orl_result note_trial(struct orl_search *s, const struct orl_trial *trial)
{
    ORL_TRY(ORL_GROW(s->log, s->trials, s->trial_capacity, s->trial_count));
    s->trials[s->trial_count++] = *trial;
    if (s->params.on_trial)
        s->params.on_trial(s->params.priv, trial);
    return ORL_OK;
}

// Measures a choice and keeps it if it is better than the best so far, or the first. `same`: the
// change has no effect at all.
static enum orl_result try_choice(struct orl_search *s, const struct orl_choice *choice,
                                  struct orl_trial *trial, bool *same)
{
    struct orl_score score = {0};
    double done = (double)s->trial_count, total = fmax(s->planned, done + 1);
    orl_progress_report(s->params.progress, "search", done, total, trial->key);
    ORL_TRY(orl_score_measure(s->log, s->renderer, &s->validation, s->validation.count, &choice->params, NULL,
                              s->params.progress, &score));
    trial->psnr_db = score.psnr_db;
    trial->ssim = score.ssim;
    trial->kept = !s->score.count || orl_score_better(&score, &s->score, s->params.gain_db);
    *same = score.psnr_db == s->score.psnr_db && score.ssim == s->score.ssim;
    if (trial->kept) {
        orl_score_finish(&s->score);
        s->score = score;
        s->best = *choice;
    } else {
        orl_score_finish(&score);
    }
    return note_trial(s, trial);
}

// --- numbers ---

static float *field(struct orl_render_params *params, const struct orl_option *option)
{
    return (float *)((char *)params + option->offset);
}

// The next of the option's values to try beyond `from`; NAN: none.
static double next_try(const struct orl_option *option, double from, int direction)
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

static enum orl_result move_number(struct orl_search *s, const struct orl_option *option,
                                   bool *better)
{
    enum orl_result result = ORL_OK;
    bool moved = false, same = false;
    for (int direction = 1; direction >= -1 && !moved && !same; direction -= 2) {
        struct orl_trial trial = {.key = option->name, .kept = true};
        while (result == ORL_OK && trial.kept && !is_over(s)) {
            struct orl_choice choice = s->best;
            double value = next_try(option, (double)*field(&choice.params, option), direction);
            if (isnan(value))
                break;
            *field(&choice.params, option) = (float)value;
            trial.value = value;
            result = try_choice(s, &choice, &trial, &same);
            moved = moved || (result == ORL_OK && trial.kept);
        }
    }
    *better = *better || moved;
    return result;
}

static bool is_chosen(const struct orl_search *s, const struct orl_option *option,
                      const struct orl_names *keys)
{
    if (option->try_count == 0 || !orl_render_option_read(option, &s->best.params))
        return false;
    return !keys || !keys->count || orl_names_contain(keys, option->name);
}

// Searches one number after another among the values that its row has to try, upwards and downwards
// while the result gets better. Repeats rounds over all of them until a round brings no gain.
static enum orl_result numbers(struct orl_search *s, const struct orl_names *keys)
{
    bool better = true;
    s->planned = (double)s->trial_count;
    for (const struct orl_option *o = orl_render_options(); o->name; o++)
        s->planned += is_chosen(s, o, keys) ? 3 : 0;
    for (int round = 0; better && round < ROUNDS_MAX && !is_over(s); round++) {
        better = false;
        for (const struct orl_option *o = orl_render_options(); o->name; o++)
            if (is_chosen(s, o, keys))
                ORL_TRY(move_number(s, o, &better));
    }
    s->complete = !is_over(s);
    return ORL_OK;
}

static enum orl_result check_keys(const struct orl_log *log, const struct orl_names *keys)
{
    for (size_t i = 0; keys && i < keys->count; i++) {
        const struct orl_option *option = orl_render_option_find(keys->items[i]);
        if (!option || option->try_count == 0)
            return orl_fail(log, ORL_ERR_ARGUMENT, "%s: not an option that can be tuned",
                            keys->items[i]);
    }
    return ORL_OK;
}

enum orl_result orl_search_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                               const struct orl_scene *scene,
                               const struct orl_search_params *params,
                               const struct orl_choice *start, const struct orl_names *keys,
                               struct orl_search *s)
{
    *s = (struct orl_search){.log = orl_gpu_log(gpu), .renderer = renderer, .scene = scene,
                             .params = *params, .start_s = orl_time_s(), .complete = true};
    ORL_REQUIRE(s->log, params->size_divide >= 1 && params->size_divide <= ORL_SEARCH_DIVIDE_MAX);
    enum orl_result result = check_keys(s->log, keys);
    ORL_THEN(result, orl_validation_load(s->log, scene, (size_t)params->views, params->size_divide, &s->validation));
    struct orl_trial first = {.key = NULL};
    bool same;
    ORL_THEN(result, try_choice(s, start, &first, &same));
    ORL_THEN(result, numbers(s, keys));
    if (result == ORL_OK)
        orl_progress_report(params->progress, "search", 1, 1, NULL);
    else
        orl_search_finish(s);
    return result;
}

// --- the backdrop ---

enum orl_result orl_search_backdrop(const struct orl_log *log, struct orl_renderer *renderer, struct orl_scene *scene,
                                    const struct orl_search_params *params, const struct orl_choice *choice)
{
    struct orl_validation validation = {0};
    struct orl_score scores[2] = {{0}};
    enum orl_result result = orl_validation_load(log, scene, (size_t)params->views, params->size_divide,
                                                 &validation);
    for (int rests = 0; rests < 2; rests++) {
        scene->backdrop_rests = rests;
        ORL_THEN(result, orl_score_measure(log, renderer, &validation, validation.count, &choice->params, NULL,
                                           params->progress, &scores[rests]));
    }
    scene->backdrop_rests = result == ORL_OK && orl_score_better(&scores[1], &scores[0], params->gain_db);
    orl_score_finish(&scores[0]);
    orl_score_finish(&scores[1]);
    orl_validation_finish(&validation);
    return result;
}

// --- what was found ---

json_t *orl_search_record(const struct orl_search *s)
{
    return orl_choice_record(&s->best, s->trials[0].psnr_db, s->score.psnr_db, s->validation.count,
                             s->params.size_divide, s->complete);
}

json_t *orl_search_report(const struct orl_search *s, const char *device)
{
    json_t *root = orl_search_record(s), *trials = json_array();
    for (size_t i = 0; i < s->trial_count; i++) {
        const struct orl_trial *t = &s->trials[i];
        json_array_append_new(trials, json_pack("{s:s?, s:o, s:f, s:f, s:b}", "key", t->key, "value",
                                                t->key ? json_real(t->value) : json_null(),
                                                "psnr_db", t->psnr_db, "ssim", t->ssim, "kept",
                                                t->kept));
    }
    json_object_set_new(root, "scene", orl_json_string(s->scene->dir));
    json_object_set_new(root, "method", json_string(s->best.method->name));
    json_object_set_new(root, "device", json_string(device));
    json_object_set_new(root, "trials", trials);
    return root;
}
