#include "eval/adapt.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/process.h"
#include "eval/trim.h"
#include "scene/tuned_settings.h"

// Of the time that is left after the methods are compared, tuning may take this share.
static const double tune_share = 0.7;
// Settings may lose so much, which no one sees; a gain must be at least half of it.
static const double tolerance_db = 0.02, tolerance_ssim = 0.002, gain_db = 0.01;
// What a step must gain. Gains that did not hold on photographs that were held out were smaller.
static const double step_gain_db = 0.15;

static size_t ranks_above(const struct orl_trial *rows, size_t count, size_t row)
{
    size_t sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += rows[i].psnr_db > rows[row].psnr_db;
        sum += rows[i].ssim > rows[row].ssim;
    }
    return sum;
}

size_t orl_adapt_choose(const struct orl_trial *rows, size_t count)
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
    const struct orl_scene *scene;
    const struct orl_adapt_params *params;
    struct orl_adapt *adapt;
    struct orl_search search;
    size_t renderings; // done, in steps
};

static double left_s(const struct job *job)
{
    return job->params->budget_s - (orl_time_s() - job->search.start_s);
}

// Gives what comes next this share of the time that is left for all but the comparison of methods.
static void give_time(struct job *job, double share)
{
    job->search.params.budget_s = job->params->budget_s - (1 - share) * fmax(left_s(job), 0);
}

// Measures one method. A method that cannot draw the scene, as one that needs a mesh, has no row.
static enum orl_result add_method(struct job *job, const struct orl_method *method)
{
    struct orl_adapt *adapt = job->adapt;
    const struct orl_search *s = &job->search;
    struct orl_render_params render;
    struct orl_score score = {0};
    orl_render_params_tuned(s->log, method, job->scene, &render);
    enum orl_result result = orl_score_measure(s->log, s->renderer, &s->validation, &render,
                                               job->params->progress, &score);
    if (result == ORL_OK)
        adapt->rows[adapt->row_count++] = (struct orl_trial){
            .method = method, .psnr_db = score.psnr_db, .ssim = score.ssim};
    orl_score_finish(&score);
    bool fatal = result == ORL_ERR_MEMORY || result == ORL_ERR_GPU || result == ORL_ERR_CANCELLED;
    return fatal ? result : ORL_OK;
}

static enum orl_result compare_methods(struct job *job)
{
    struct orl_adapt *adapt = job->adapt;
    const struct orl_log *log = job->search.log;
    size_t count = 0;
    enum orl_result result = ORL_OK;
    while (count < ORL_ADAPT_METHODS_MAX && orl_methods[count].name)
        count++;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        orl_progress_report(job->params->progress, "methods", (double)i, (double)count,
                            orl_methods[i].name);
        if (!orl_method_is_for_stills(&orl_methods[i]))
            result = add_method(job, &orl_methods[i]);
    }
    if (result == ORL_OK && !adapt->row_count)
        result = orl_fail(log, ORL_ERR_DATA, "%s: no method can draw this scene",
                          job->scene->dir);
    if (result != ORL_OK)
        return result;
    adapt->chosen = orl_adapt_choose(adapt->rows, adapt->row_count);
    struct orl_choice choice = {.method = adapt->rows[adapt->chosen].method};
    orl_render_params_tuned(log, choice.method, job->scene, &choice.params);
    return orl_search_start(&job->search, &choice);
}

// --- what can be saved ---

static enum orl_result trim(struct job *job, struct orl_gpu *gpu)
{
    struct orl_trim trim;
    const struct orl_trim_params trimming = {
        .start = &job->search.best, .tolerance_db = tolerance_db, .tolerance_ssim = tolerance_ssim,
        .worst_db = 5 * tolerance_db, .views = job->params->views,
        .size_divide = job->params->size_divide, .budget_s = left_s(job), .settings_only = true,
        .progress = job->params->progress};
    enum orl_result result = orl_trim_run(gpu, job->scene, &trimming, &trim);
    if (result != ORL_OK)
        return result;
    job->adapt->complete = job->adapt->complete && trim.complete;
    job->search.best = trim.choice;
    job->adapt->defaults = trim.defaults;
    orl_trim_finish(&trim);
    return ORL_OK;
}

// Notes what the search has found so far.
static void note_best(struct job *job)
{
    job->adapt->tuned_db = job->search.score.psnr_db;
    job->adapt->tuned_ssim = job->search.score.ssim;
}

static enum orl_result search(struct job *job, struct orl_gpu *gpu)
{
    struct orl_search *s = &job->search;
    enum orl_result result = compare_methods(job);
    job->adapt->plain_db = s->score.psnr_db;
    job->adapt->plain_ssim = s->score.ssim;
    give_time(job, 1);
    if (result == ORL_OK && left_s(job) > 0)
        result = orl_search_borrow(s);
    give_time(job, tune_share);
    if (result == ORL_OK && left_s(job) > 0) {
        result = orl_search_numbers(s, NULL);
        job->adapt->complete = s->complete;
    }
    note_best(job);
    // Trimming has a renderer of its own.
    orl_renderer_destroy(&s->renderer);
    if (result == ORL_OK && left_s(job) > 0)
        result = trim(job, gpu);
    return result;
}

// --- the few steps ---

// What the scene must be, or the step before must have brought.
enum step_condition { ALWAYS, AFTER_NO_GAIN };

struct step {
    enum step_condition condition;
    const char *method;      // NULL: the one so far
    const char *settings[1]; // KEY=VALUE
};

// In the order of what they gained on the training photographs of measured scenes.
static const struct step steps[] = {
    {ALWAYS, NULL, {"depth_tolerance=0.003"}}, // exact points, thin things
    {AFTER_NO_GAIN, NULL, {"depth_tolerance=0.04"}},
    {ALWAYS, NULL, {"photos_per_pixel=2"}}, // few photographs of a subject
    {ALWAYS, NULL, {"antialias=off"}}, // many small photographs, which the view is near to
    {ALWAYS, "oriel-fast", {NULL}},
};

size_t orl_adapt_renderings(const struct orl_scene *scene)
{
    // Of processor time, with llvmpipe on an AMD EPYC: prepare takes 10 s for a photograph and 17 s
    // for each of its megapixels, and a rendering 1 to 1.5 s for each.
    static const double per_photo = 1, per_photo_mpx = 0.9;
    static const size_t most = 36; // a larger scene does not need more
    double pixels = 0, train = 0;
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_camera *camera = &scene->photos[i].view.camera;
        if (!scene->photos[i].test) {
            pixels += (double)camera->width * camera->height;
            train++;
        }
    }
    double count = pixels > 0 ? train * (per_photo + per_photo_mpx * 1e6 * train / pixels) : 0;
    return count < (double)most ? (size_t)count : most;
}

static enum orl_result set_step(const struct job *job, const struct step *step,
                                struct orl_choice *choice)
{
    enum orl_result result = ORL_OK;
    *choice = job->search.best;
    if (step->method) {
        choice->method = orl_method_find(job->search.log, step->method);
        if (!choice->method)
            return ORL_ERR_ARGUMENT;
        orl_render_params_tuned(job->search.log, choice->method, job->scene, &choice->params);
    }
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(step->settings); i++)
        if (step->settings[i])
            result = orl_render_params_set(job->search.log, &choice->params, step->settings[i]);
    return result;
}

// Changes nothing, as a step does whose settings another has brought.
static bool is_same(const struct orl_choice *a, const struct orl_choice *b)
{
    json_t *settings[] = {orl_choice_settings(a->method, &a->params),
                          orl_choice_settings(b->method, &b->params)};
    bool same = a->method == b->method && json_equal(settings[0], settings[1]);
    json_decref(settings[0]);
    json_decref(settings[1]);
    return same;
}

static enum orl_result render_views(struct job *job, const struct orl_choice *choice, size_t count,
                              struct orl_score *score)
{
    orl_progress_report(job->params->progress, "adapt", (double)job->renderings,
                        (double)orl_adapt_renderings(job->scene), NULL);
    job->renderings += count - score->count;
    return orl_score_extend(job->search.log, job->search.renderer, &job->search.validation,
                            &choice->params, job->params->progress, count, score);
}

// Takes the step if it is clearly better. Half of the views suffice to see that it is not.
static enum orl_result try_step(struct job *job, const struct step *step, bool *taken)
{
    struct orl_choice choice;
    struct orl_score score = {0};
    size_t count = job->search.validation.count;
    *taken = false;
    enum orl_result result = set_step(job, step, &choice);
    if (result != ORL_OK || is_same(&choice, &job->search.best))
        return result;
    result = render_views(job, &choice, (count + 1) / 2, &score);
    if (result == ORL_OK && orl_score_gain_db(&score, &job->search.score) >= step_gain_db / 2) {
        result = render_views(job, &choice, count, &score);
        *taken = result == ORL_OK &&
                 orl_score_clearly_better(&score, &job->search.score, step_gain_db);
    }
    if (*taken) {
        for (size_t i = 0; i < ORL_COUNT(step->settings) && step->settings[i]; i++)
            orl_logf(job->search.log, ORL_LOG_INFO, "adapt: %s", step->settings[i]);
        orl_logf(job->search.log, ORL_LOG_INFO, "adapt: %s: %.2f dB, SSIM %.4f", choice.method->name,
                 score.psnr_db, score.ssim);
        orl_score_finish(&job->search.score);
        job->search.score = score;
        job->search.best = choice;
        return ORL_OK;
    }
    orl_score_finish(&score);
    return result;
}

static bool is_for(enum step_condition condition, bool taken)
{
    return condition == ALWAYS || !taken;
}

static enum orl_result take_steps(struct job *job)
{
    struct orl_adapt *adapt = job->adapt;
    const struct orl_names none = {0};
    size_t most = orl_adapt_renderings(job->scene), count = job->search.validation.count;
    bool taken = false;
    enum orl_result result =
        orl_choice_make(job->search.log, job->scene, ORL_SAMPLE_SRGB, NULL, &none, &job->search.best);
    if (result == ORL_OK)
        result = render_views(job, &job->search.best, count, &job->search.score);
    adapt->plain_db = job->search.score.psnr_db;
    adapt->plain_ssim = job->search.score.ssim;
    adapt->complete = true;
    for (size_t i = 0; result == ORL_OK && adapt->complete && i < ORL_COUNT(steps); i++) {
        if (!is_for(steps[i].condition, taken))
            continue;
        adapt->complete = job->renderings + count <= most; // what begins must be able to end
        if (adapt->complete)
            result = try_step(job, &steps[i], &taken);
    }
    note_best(job);
    orl_progress_report(job->params->progress, "adapt", 1, 1, NULL);
    return result;
}

// --- all of it ---

enum orl_result orl_adapt_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                              const struct orl_adapt_params *params, struct orl_adapt *adapt)
{
    struct job job = {.scene = scene, .params = params, .adapt = adapt};
    struct orl_renderer *renderer = NULL;
    const struct orl_search_params searching = {
        .size_divide = params->size_divide, .views = params->views, .gain_db = gain_db,
        .progress = params->progress};
    memset(adapt, 0, sizeof *adapt);
    adapt->defaults = scene->defaults;
    enum orl_result result = orl_renderer_create(gpu, scene, NULL, &renderer);
    if (result == ORL_OK)
        result = orl_search_begin(gpu, renderer, scene, &searching, &job.search);
    adapt->views = job.search.validation.count;
    if (result == ORL_OK)
        result = params->search ? search(&job, gpu) : take_steps(&job);
    orl_renderer_destroy(&job.search.renderer);
    adapt->choice = job.search.best;
    orl_search_finish(&job.search);
    if (result == ORL_OK)
        adapt->defaults.method = (char *)adapt->choice.method->name;
    return result;
}

// --- where commands find it ---

json_t *orl_adapt_json(const struct orl_adapt *adapt)
{
    const struct orl_choice *choice = &adapt->choice;
    json_t *settings = orl_choice_settings(choice->method, &choice->params);
    return json_pack("{s:{s:{s:o}}, s:o}", "tuned", choice->method->name, "settings", settings,
                     "render", orl_defaults_json(&adapt->defaults));
}

enum orl_result orl_adapt_store(const struct orl_log *log, const char *dir,
                                const struct orl_adapt *adapt)
{
    const struct orl_choice *choice = &adapt->choice;
    json_t *record = json_pack("{s:o}", "settings",
                               orl_choice_settings(choice->method, &choice->params));
    enum orl_result result = orl_tuned_write(log, dir, choice->method->name, record);
    return result == ORL_OK ? orl_defaults_write(log, dir, &adapt->defaults) : result;
}
