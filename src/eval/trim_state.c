// States of a trimmed scene: the models that they are drawn with, what they lose against the whole
// scene, how long their frames take, and which are taken.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/process.h"
#include "eval/timing.h"
#include "eval/trim_search.h"

const double orl_trim_point_shares[TRIM_POINT_LEVELS] = {
    1,    0.9,  0.8, 0.72, 0.65,  0.57, 0.5, 0.45, 0.4,  0.36, 0.32, 0.28, 0.25,
    0.22, 0.2, 0.18, 0.16, 0.14, 0.125, 0.11, 0.1, 0.09, 0.08, 0.07, 0.0625};

// --- models ---

struct orl_scene_defaults orl_trim_defaults(const struct trim_search *s, const struct trim_state *state)
{
    struct orl_scene_defaults defaults = s->scene->defaults;
    if (state->level[ORL_TRIM_TEXTURES] != ORL_TEXTURES_AUTO)
        defaults.textures = (char *)orl_textures_names[state->level[ORL_TRIM_TEXTURES]];
    int divide = (int)state->level[ORL_TRIM_DEPTH];
    if (divide > 0) {
        defaults.depth_half = true;
        defaults.depth_divide = defaults.depth_divide > divide ? defaults.depth_divide : divide;
    }
    return defaults;
}

void orl_trim_count_bytes(const struct orl_gpu *gpu, size_t *points, size_t *photos)
{
    struct orl_gpu_memory rows[64];
    size_t count = orl_gpu_memory(gpu, rows, ORL_COUNT(rows));
    *points = *photos = 0;
    for (size_t i = 0; i < count && i < ORL_COUNT(rows); i++) {
        if (rows[i].owner == ORL_OWNER_POINTS)
            *points += rows[i].bytes;
        else if (rows[i].owner == ORL_OWNER_PHOTOGRAPHS &&
                 strcmp(rows[i].tag, "photograph being loaded") != 0)
            *photos += rows[i].bytes;
    }
}

static void close_model(struct trim_state *state)
{
    orl_renderer_destroy(&state->model.renderer);
    orl_points_finish(&state->model.points);
}

enum orl_result orl_trim_model_open(const struct trim_search *s, struct trim_state *state)
{
    size_t points, photos, all = s->scene->points.count;
    size_t count = (size_t)(orl_trim_point_shares[state->level[ORL_TRIM_POINTS]] * (double)all + 0.5);
    struct trim_model *model = &state->model;
    model->scene = *s->scene;
    model->scene.defaults = orl_trim_defaults(s, state);
    if (count < all) {
        ORL_TRY(orl_points_thin_out(s->log, &s->scene->points, s->ranking.order, count, &model->points));
        model->scene.points = model->points;
    }
    orl_trim_count_bytes(s->gpu, &points, &photos);
    ORL_TRY(orl_renderer_create(s->gpu, &model->scene, NULL, &model->renderer));
    // Depth maps and masks of photographs take memory only once a method has asked for them.
    ORL_TRY(orl_renderer_draw(model->renderer, &s->targets.views[0].view, &state->render, state->removed, NULL));
    orl_trim_count_bytes(s->gpu, &model->point_bytes, &model->photo_bytes);
    model->point_bytes -= points;
    model->photo_bytes -= photos;
    return ORL_OK;
}

const struct trim_model *orl_trim_model_of(const struct trim_state *state)
{
    while (!state->model.renderer)
        state = state->before;
    return &state->model;
}

void orl_trim_models_close(struct trim_state *state)
{
    for (; state; state = state->before)
        close_model(state);
}

double orl_trim_model_bytes(const struct trim_search *s, const struct trim_state *state)
{
    const struct trim_model *model = orl_trim_model_of(state);
    double left = (double)(s->targets.count - state->removed_count) / (double)s->targets.count;
    return (double)model->point_bytes + (double)model->photo_bytes * left;
}

// --- states ---

enum orl_result orl_trim_state_begin(const struct trim_search *s, enum orl_trim_part part, struct trim_state **out)
{
    const size_t size = sizeof **out + s->scene->photo_count * sizeof *(*out)->removed;
    struct trim_state *state = orl_array(s->log, 1, size);
    *out = state;
    ORL_TRY_MEMORY(state);
    if (s->now)
        memcpy(state, s->now, size);
    else
        *state = (struct trim_state){.render = s->params->start->params, .slower = 1};
    state->before = s->now;
    state->model = (struct trim_model){0};
    state->shares = false;
    state->step = (struct orl_trim_step){.part = part};
    state->score = (struct orl_score){0};
    return ORL_OK;
}

void orl_trim_state_destroy(struct trim_state **state)
{
    if (*state) {
        close_model(*state);
        orl_score_finish(&(*state)->score);
    }
    free(*state);
    *state = NULL;
}

// --- figures of a state ---

// Measures the first `count` targets in the state.
static enum orl_result measure(struct trim_search *s, struct trim_state *t, size_t count)
{
    ORL_TRY(orl_score_measure(s->log, orl_trim_model_of(t)->renderer, &s->targets, count, &t->render, t->removed,
                              s->params->progress, &t->score));
    t->loss = orl_score_loss(&s->first->score, &t->score);
    return ORL_OK;
}

enum orl_result orl_trim_measure(struct trim_search *s, struct trim_state *t)
{
    if (!t->shares)
        ORL_TRY(orl_trim_model_open(s, t));
    t->step.bytes = orl_trim_model_bytes(s, t);
    ORL_TRY(measure(s, t, s->validation_count));
    // A few targets leave it open that all that decide allow the step.
    const struct orl_score_loss half = {fmin(t->loss.psnr_db, t->loss.psnr_db / 2),
                                        fmin(t->loss.ssim, t->loss.ssim / 2), t->loss.worst_db};
    if (orl_trim_fits(s, &half, 1))
        ORL_TRY(measure(s, t, s->deciding_count));
    const struct orl_score_loss loss = orl_score_loss(&t->before->score, &t->score);
    t->step.loss_db = loss.psnr_db;
    t->step.loss_ssim = loss.ssim;
    return ORL_OK;
}

// How much may be lost in all when now so much is lost, and a step may use this share of what is left.
static double allowed(double now, double most, double share)
{
    return fmin(now + share * (most - now), most);
}

bool orl_trim_fits(const struct trim_search *s, const struct orl_score_loss *loss, double share)
{
    const struct orl_score_loss *now = &s->now->loss, *most = &s->most;
    return loss->psnr_db <= allowed(now->psnr_db, most->psnr_db, share) &&
           loss->ssim <= allowed(now->ssim, most->ssim, share) && loss->worst_db <= most->worst_db;
}

// --- the time of a frame ---

// Only ratios of frames drawn in turns decide, since other programs on the machine change all times.
enum { ROUNDS_OF_FIRST = 5, ROUNDS_OF_TRIAL = 24, ROUNDS_OF_WHOLE = 64 };
// No frame may be slower than the whole scene's by more than this share, or so many milliseconds,
// which no one sees.
static const double slower_max = 0.02, slower_ms = 0.5, slower_software_ms = 8;
// Standard error of a trial's ratio that is asked for, if as many rounds are enough for it: in the
// end both models are timed more closely.
static const double trial_error = 0.025;
// A difference within so many standard errors counts as none.
static const double same_errors = 2;

// Two states whose frames are timed in turns. Each round has another view.
struct pair {
    const struct trim_search *s;
    const struct trim_state *states[2];
    size_t frames;
};

static enum orl_result time_frame(void *priv, bool second, double *ms)
{
    struct pair *pair = priv;
    const struct trim_search *s = pair->s;
    const struct trim_state *state = pair->states[second];
    const struct orl_view *view = &s->targets.views[pair->frames++ / 2 % s->validation_count].view;
    double (*const clock)(void) = orl_gpu_caps(s->gpu)->software ? orl_cpu_time_s : orl_time_s;
    struct orl_render_params render = state->render;
    if (orl_progress_cancelled(s->params->progress))
        return ORL_ERR_CANCELLED;
    render.leave_out |= ORL_LAYER_NORMAL;
    const double start = clock();
    ORL_TRY(orl_renderer_draw(orl_trim_model_of(state)->renderer, view, &render, state->removed, NULL));
    *ms = 1e3 * (clock() - start);
    return ORL_OK;
}

static enum orl_result compare(const struct trim_search *s, const struct trim_state *first,
                               const struct trim_state *second, double limit, double error, size_t rounds_max,
                               struct orl_pair_timing *timing)
{
    struct pair pair = {s, {first, second}, 0};
    const struct orl_pair_timing_params params = {.time = time_frame, .priv = &pair, .limit = limit,
                                                  .error = error, .rounds_max = rounds_max};
    double unused;
    // The first frame of each view reads the photographs that the view is painted from.
    for (size_t k = 0; k < 2 * s->validation_count; k++)
        ORL_TRY(time_frame(&pair, k % 2, &unused));
    ORL_TRY(orl_pair_timing_take(&params, timing));
    orl_logf(s->log, ORL_LOG_DEBUG, "frames take %.3f times as long (standard error %.1f %%, limit %.3f), %zu rounds",
             timing->ratio, 100 * timing->error, limit, timing->rounds);
    return ORL_OK;
}

double orl_trim_slow_limit(const struct trim_search *s)
{
    double least = orl_gpu_caps(s->gpu)->software ? slower_software_ms : slower_ms;
    return 1 + fmax(slower_max, least / s->first_ms);
}

enum orl_result orl_trim_time_first(struct trim_search *s)
{
    struct orl_pair_timing timing;
    ORL_TRY(compare(s, s->first, s->first, 1, 0, ROUNDS_OF_FIRST, &timing));
    s->first_ms = timing.ms;
    return ORL_OK;
}

enum orl_result orl_trim_time_trial(struct trim_search *s, struct trim_state *t)
{
    struct orl_pair_timing timing;
    double limit = orl_trim_slow_limit(s) / t->before->slower;
    ORL_TRY(compare(s, t->before, t, limit, trial_error, ROUNDS_OF_TRIAL, &timing));
    bool same = fabs(log(timing.ratio)) <= same_errors * timing.error;
    t->slower = t->before->slower * (same ? 1 : timing.ratio);
    return ORL_OK;
}

enum orl_result orl_trim_time_whole(struct trim_search *s, bool *slow)
{
    struct orl_pair_timing timing;
    double limit = orl_trim_slow_limit(s);
    bool closed = !s->first->model.renderer;
    if (closed)
        ORL_TRY(orl_trim_model_open(s, s->first));
    enum orl_result result = compare(s, s->first, s->now, limit, 0, ROUNDS_OF_WHOLE, &timing);
    if (closed)
        orl_trim_models_close(s->first);
    ORL_TRY(result);
    s->trim->before.frame_ms = timing.ms;
    s->trim->after.frame_ms = timing.ratio * timing.ms;
    s->now->slower = timing.ratio;
    *slow = !orl_trim_has_budget(s) && orl_pair_timing_above(&timing, limit);
    return ORL_OK;
}

// --- steps that are taken ---

enum orl_result orl_trim_take(struct trim_search *s, struct trim_state **trial)
{
    struct orl_trim *trim = s->trim;
    struct trim_state *t = *trial;
    ORL_TRY(ORL_GROW(s->log, trim->steps, trim->step_capacity, trim->step_count));
    t->step.taken = true;
    t->step.ms = s->first_ms * t->slower;
    t->step.total_loss_db = t->loss.psnr_db;
    t->step.total_loss_ssim = t->loss.ssim;
    trim->steps[trim->step_count++] = t->step;
    if (s->params->on_step)
        s->params->on_step(s->params->priv, &t->step);
    if (t->model.renderer)
        orl_trim_models_close(t->before);
    s->now = t;
    *trial = NULL;
    return ORL_OK;
}

enum orl_result orl_trim_measure_all(struct trim_search *s, struct orl_trim_figures *figures)
{
    const char *what = s->trim->step_count ? "trimmed scene" : "whole scene";
    struct trim_state *now = s->now;
    for (size_t i = 0; i < s->targets.count; i++) {
        orl_progress_report(s->params->progress, what, (double)i, (double)s->targets.count, NULL);
        ORL_TRY(measure(s, now, i + 1));
    }
    *figures = (struct orl_trim_figures){
        .frame_ms = figures->frame_ms, .psnr_db = now->score.psnr_db, .ssim = now->score.ssim,
        .worst_loss_db = now->loss.worst_db, .points = orl_trim_model_of(now)->scene.points.count,
        .photographs = s->targets.count - now->removed_count};
    return ORL_OK;
}

static enum orl_result take_back(struct trim_search *s)
{
    struct trim_state *last = s->now;
    bool own = last->model.renderer;
    s->now = last->before;
    s->trim->steps[s->trim->step_count - ++s->trim->undone].taken = false;
    orl_trim_state_destroy(&last);
    return own ? orl_trim_model_open(s, s->now) : ORL_OK;
}

enum orl_result orl_trim_confirm(struct trim_search *s)
{
    enum orl_result result = orl_trim_measure_all(s, &s->trim->after);
    while (result == ORL_OK && s->now != s->first && !orl_trim_fits(s, &s->now->loss, 1)) {
        result = take_back(s);
        ORL_THEN(result, orl_trim_measure_all(s, &s->trim->after));
    }
    return result;
}
