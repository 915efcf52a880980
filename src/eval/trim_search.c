// The search of oriel trim. A state is what is left of a scene; it is measured by what its pictures lose and how long its
// frames take. A ladder of steps leads from one state to the next: its rungs are the parts of the model, first those that
// saved most for what they lost on the scenes that were measured. Each part is made as small as the tolerances allow:
// parts with few levels one level after the other, points and photographs by bisection.
#include "eval/trim_search.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/process.h"
#include "eval/search.h"
#include "eval/timing.h"

// Levels of points and of depth maps, from the whole scene on.
static const double point_shares[] = {
    1,    0.9,  0.8, 0.72, 0.65,  0.57, 0.5, 0.45, 0.4,  0.36, 0.32, 0.28, 0.25,
    0.22, 0.2, 0.18, 0.16, 0.14, 0.125, 0.11, 0.1, 0.09, 0.08, 0.07, 0.0625};

static bool has_budget(const struct trim_search *s)
{
    return s->params->max_mib > 0 || s->params->max_frame_ms > 0;
}

// --- models ---

// How the scene is drawn in this state. Texts are static or the search's scene's.
static struct orl_scene_defaults defaults_of(const struct trim_search *s, const struct trim_state *state)
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
    size_t count = (size_t)(point_shares[state->level[ORL_TRIM_POINTS]] * (double)all + 0.5);
    struct trim_model *model = &state->model;
    model->scene = *s->scene;
    model->scene.defaults = defaults_of(s, state);
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

// Bytes of points and photographs on the device in this state.
static double model_bytes(const struct trim_search *s, const struct trim_state *state)
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

// How much may be lost in all when now so much is lost, and a step may use this share of what is left.
static double allowed(double now, double most, double share)
{
    return fmin(now + share * (most - now), most);
}

// Whether the losses are within the tolerances, of which the step may use this share of what is left.
static bool fits(const struct trim_search *s, const struct orl_score_loss *loss, double share)
{
    const struct orl_score_loss *now = &s->now->loss, *most = &s->most;
    return loss->psnr_db <= allowed(now->psnr_db, most->psnr_db, share) &&
           loss->ssim <= allowed(now->ssim, most->ssim, share) && loss->worst_db <= most->worst_db;
}

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
    t->step.bytes = model_bytes(s, t);
    ORL_TRY(measure(s, t, s->validation_count));
    // A few targets leave it open that all that decide allow the step.
    const struct orl_score_loss half = {fmin(t->loss.psnr_db, t->loss.psnr_db / 2),
                                        fmin(t->loss.ssim, t->loss.ssim / 2), t->loss.worst_db};
    if (fits(s, &half, 1))
        ORL_TRY(measure(s, t, s->deciding_count));
    const struct orl_score_loss loss = orl_score_loss(&t->before->score, &t->score);
    t->step.loss_db = loss.psnr_db;
    t->step.loss_ssim = loss.ssim;
    return ORL_OK;
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

// In the end a frame may take so many times as long as the whole scene's.
static double slow_limit(const struct trim_search *s)
{
    double least = orl_gpu_caps(s->gpu)->software ? slower_software_ms : slower_ms;
    return 1 + fmax(slower_max, least / s->first_ms);
}

// Compares frames of a state on trial with those of the state before: `slower`.
static enum orl_result time_trial(struct trim_search *s, struct trim_state *t)
{
    struct orl_pair_timing timing;
    double limit = slow_limit(s) / t->before->slower;
    ORL_TRY(compare(s, t->before, t, limit, trial_error, ROUNDS_OF_TRIAL, &timing));
    bool same = fabs(log(timing.ratio)) <= same_errors * timing.error;
    t->slower = t->before->slower * (same ? 1 : timing.ratio);
    return ORL_OK;
}

// Compares frames of the search's state with those of the whole scene, for the report. slow: they are clearly slower than
// they may be.
static enum orl_result time_whole(struct trim_search *s, bool *slow)
{
    struct orl_pair_timing timing;
    double limit = slow_limit(s);
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
    *slow = !has_budget(s) && orl_pair_timing_above(&timing, limit);
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
    while (result == ORL_OK && s->now != s->first && !fits(s, &s->now->loss, 1)) {
        result = take_back(s);
        ORL_THEN(result, orl_trim_measure_all(s, &s->trim->after));
    }
    return result;
}

const char *const orl_trim_part_names[ORL_TRIM_PART_COUNT] = {
    "points", "photograph", "textures", "depth", "option"};

enum { DEPTH_LEVELS = 5 };

enum {
    BISECTIONS = 5,      // of points or photographs
    BUDGET_DIVIDE = 12,  // towards a budget they go in so many steps
};
// The last part of the time is for a frame that has become too slow.
static const double time_for_ladder = 0.8;
// Towards a budget the tolerances grow from the first of these by the second, up to the third.
static const double budget_first_db = 0.025, budget_growth = 2, budget_last_db = 100;
// SSIM of the same size, as the default tolerances have it.
static const double ssim_per_db = 0.1;

// Options whose cheaper values save time: levels of their own, each of which is tried from every state.
static const char *const cheaper[] = {
    "sampling=bilinear", "antialias=off", "median=off", "guess_blur=0",
    "outliers=0", "front_layer=0", "photos_per_pixel=2"};

// `max`: the last level. `share`: of what is left of the tolerances.
struct rung {
    enum orl_trim_part part;
    size_t max;
    double share;
};
static const struct rung ladder[] = {
    {ORL_TRIM_DEPTH, 1, 1}, // half floats, which lose nothing
    {ORL_TRIM_TEXTURES, ORL_TEXTURES_YCC, 1},
    {ORL_TRIM_DEPTH, DEPTH_LEVELS - 1, 1},
    {ORL_TRIM_TEXTURES, ORL_TEXTURES_BC1, 1},
    {ORL_TRIM_PHOTOGRAPH, SIZE_MAX, 0.5},
    {ORL_TRIM_POINTS, ORL_COUNT(point_shares) - 1, 1},
    {ORL_TRIM_OPTION, ORL_COUNT(cheaper), 1},
};
static const struct rung *const textures = &ladder[1], *const options = &ladder[ORL_COUNT(ladder) - 1];

// --- levels ---

// The last level that the scene allows.
static size_t max_level(const struct trim_search *s, const struct rung *rung)
{
    if (rung->part == ORL_TRIM_PHOTOGRAPH)
        return s->targets.count - ORL_VALIDATION_TRAIN_MIN;
    return rung->part == ORL_TRIM_POINTS && !s->scene->points.count ? 0 : rung->max;
}

// False when the assignment changes nothing or the method does not read it.
static bool set_option(const char *assignment, struct trim_state *t)
{
    const struct orl_render_params before = t->render;
    char key[64];
    snprintf(key, sizeof key, "%.*s", (int)strcspn(assignment, "="), assignment);
    const struct orl_option *option = orl_render_option_find(key);
    if (!option || orl_render_params_set(NULL, &t->render, assignment) != ORL_OK)
        return false;
    // Where the splats change, the photographs' depth maps are drawn anew.
    t->shares = !strstr(option->readers, "proxy=");
    if (option->kind == ORL_VALUE_FLOAT)
        return orl_option_number(option, &t->render) < orl_option_number(option, &before);
    return memcmp(&t->render, &before, sizeof before) != 0;
}

// False when there is nothing to try.
static bool set_level(const struct trim_search *s, size_t level, struct trim_state *t)
{
    struct orl_scene_defaults defaults;
    enum { SIZE = sizeof t->step.what };
    t->level[t->step.part] = level;
    switch (t->step.part) {
    case ORL_TRIM_POINTS:
        snprintf(t->step.what, SIZE, "points %.3g %%", 100 * point_shares[level]);
        return true;
    case ORL_TRIM_TEXTURES:
        snprintf(t->step.what, SIZE, "textures %s",
                 level == ORL_TEXTURES_AUTO ? "as they were" : orl_textures_names[level]);
        return level == ORL_TEXTURES_AUTO ||
               (level >= ORL_TEXTURES_YCC && orl_textures_available(s->gpu, (enum orl_textures)level));
    case ORL_TRIM_DEPTH:
        defaults = defaults_of(s, t);
        snprintf(t->step.what, SIZE, "depth 1/%d, %d bits", defaults.depth_divide, defaults.depth_half ? 16 : 32);
        return true;
    case ORL_TRIM_OPTION:
        if (level == 0) {
            t->render = s->tuned;
            snprintf(t->step.what, SIZE, "tuned options");
            return true;
        }
        snprintf(t->step.what, SIZE, "%s", cheaper[level - 1]);
        return set_option(cheaper[level - 1], t);
    default:
        t->shares = true;
        return true;
    }
}

// --- budgets ---

static bool has_bytes(const struct trim_search *s)
{
    return !(s->params->max_mib > 0) || s->now->step.bytes <= s->params->max_mib * (1 << 20);
}

static bool has_time(const struct trim_search *s)
{
    return !(s->params->max_frame_ms > 0) || s->first_ms * s->now->slower <= s->params->max_frame_ms;
}

static bool within_budget(const struct trim_search *s)
{
    return has_budget(s) && has_bytes(s) && has_time(s);
}

static bool is_spent(const struct trim_search *s, double share)
{
    return s->params->budget_s > 0 && orl_time_s() - s->start_s >= share * s->params->budget_s;
}

// Whether the step loses no more than it may. The level 0 of options is the tuned ones, which must be
// better, and that of textures makes frames faster again at any price.
static bool is_allowed(const struct trim_search *s, const struct trim_state *t, double share)
{
    bool special = t->level[t->step.part] == 0;
    if (special && t->step.part == ORL_TRIM_TEXTURES)
        return true;
    return fits(s, &t->loss, share) && (!special || orl_score_better(&t->score, &s->now->score, 0));
}

// Whether the step saves what is wanted: bytes, or time by options; towards a budget, what is above it.
static bool is_wanted(const struct trim_search *s, const struct trim_state *t)
{
    bool smaller = t->step.bytes < s->now->step.bytes, faster = t->slower < s->now->slower;
    bool option = t->step.part == ORL_TRIM_OPTION;
    if (t->level[t->step.part] == 0)
        return !option || t->slower <= slow_limit(s);
    if (has_budget(s))
        return (!has_bytes(s) && smaller) || (!has_time(s) && faster);
    return option ? faster : smaller;
}

// --- steps ---

// Measures the level, and takes it if it is allowed and wanted. What loses too much to be taken is not timed, and fewer
// points and smaller maps make no frame slower. *higher: a higher level may be taken, too, since this one was or is none
// that the scene has.
static enum orl_result try_level(struct trim_search *s, const struct rung *rung, size_t level, bool *higher)
{
    struct trim_state *t;
    const enum orl_trim_part part = rung->part;
    enum orl_result result = orl_trim_state_begin(s, part, &t);
    *higher = true;
    if (result == ORL_OK && set_level(s, level, t)) {
        result = part == ORL_TRIM_PHOTOGRAPH ? orl_trim_remove_photos(s, level, t) : orl_trim_measure(s, t);
        const bool allowed = result == ORL_OK && is_allowed(s, t, rung->share);
        if (allowed && (part == ORL_TRIM_TEXTURES || part == ORL_TRIM_OPTION || s->params->max_frame_ms > 0))
            result = time_trial(s, t);
        *higher = allowed && is_wanted(s, t);
        orl_logf(s->log, ORL_LOG_DEBUG, "%s: loses %.3f dB, SSIM %.4f; in all %.3f dB, the worst %.3f dB%s",
                 t->step.what, t->step.loss_db, t->step.loss_ssim, t->loss.psnr_db, t->loss.worst_db,
                 *higher ? ": taken" : "");
        if (*higher)
            ORL_THEN(result, orl_trim_take(s, &t));
    }
    orl_trim_state_destroy(&t);
    return result;
}

// --- rungs ---

// Whether the search ends here; the time that ran out is noted.
static bool ends(struct trim_search *s)
{
    if (is_spent(s, time_for_ladder))
        s->trim->complete = false;
    return !s->trim->complete || within_budget(s);
}

// until_fast: ends as soon as a frame is as fast as it should be.
static enum orl_result climb_rung(struct trim_search *s, const struct rung *rung, bool until_fast)
{
    bool option = rung->part == ORL_TRIM_OPTION;
    bool many = rung->part == ORL_TRIM_POINTS || rung->part == ORL_TRIM_PHOTOGRAPH;
    bool halves = many && !has_budget(s);
    size_t low = option ? 0 : s->now->level[rung->part], high = max_level(s, rung);
    size_t by = many ? high / BUDGET_DIVIDE + 1 : 1;
    for (int i = 0; low < high && (!halves || i < BISECTIONS); i++) {
        size_t level = halves ? (low + high + 1) / 2 : low + by;
        bool higher;
        if (level > high || (until_fast ? s->now->slower <= slow_limit(s) || is_spent(s, 1) : ends(s)))
            break;
        ORL_TRY(try_level(s, rung, level, &higher));
        if (higher || option)
            low = level;
        else
            high = level - 1;
    }
    return ORL_OK;
}

static enum orl_result climb_ladder(struct trim_search *s)
{
    for (size_t i = 0; i < ORL_COUNT(ladder) && !ends(s); i++) {
        orl_progress_report(s->params->progress, "trim", (double)i, (double)ORL_COUNT(ladder),
                            orl_trim_part_names[ladder[i].part]);
        ORL_TRY(climb_rung(s, &ladder[i], false));
        if (ladder[i].part == ORL_TRIM_TEXTURES && !has_budget(s))
            ORL_TRY(climb_rung(s, options, true));
    }
    return ORL_OK;
}

// Takes the parts one after the other, each as far as the tolerances allow; with a budget until it holds.
static enum orl_result climb(struct trim_search *s)
{
    s->trim->complete = true;
    if (!has_budget(s))
        return climb_ladder(s);
    for (double db = budget_first_db; !ends(s) && db < budget_last_db; db *= budget_growth) {
        s->most.psnr_db = db;
        s->most.ssim = ssim_per_db * db;
        ORL_TRY(climb_ladder(s));
    }
    s->most.psnr_db = s->most.ssim = INFINITY; // nothing is taken back
    if (!within_budget(s))
        return orl_fail(s->log, ORL_ERR_DATA,
                        "%s: the least model%s takes %.2f MiB and %.1f ms a frame, which is more "
                        "than is allowed", s->scene->dir, s->trim->complete ? "" : " found before --budget ran out",
                        s->now->step.bytes / (1 << 20), s->first_ms * s->now->slower);
    return ORL_OK;
}

// Makes a frame that takes longer than it may faster: by cheaper options, or without compressed textures.
static enum orl_result make_faster(struct trim_search *s)
{
    bool slow, taken;
    ORL_TRY(time_whole(s, &slow));
    if (slow) {
        ORL_TRY(climb_rung(s, options, true));
        ORL_TRY(time_whole(s, &slow));
    }
    if (slow && s->now->level[ORL_TRIM_TEXTURES] != ORL_TEXTURES_AUTO) {
        ORL_TRY(try_level(s, textures, ORL_TEXTURES_AUTO, &taken));
        ORL_TRY(time_whole(s, &slow));
    }
    return ORL_OK;
}

// --- the whole search ---

enum { RANKED_VIEWS = 48, TUNED_VIEWS = 6, TUNED_DIVIDE = 2 };
enum { DECIDING_MAX = 48 }; // targets that decide on a step; all confirm the whole
// Least gain of a tuned option, as a share of the tolerance.
static const double tuned_gain = 0.1;
// Share of the time that tuning may take.
static const double tuned_time = 0.2;

// Moves `count` of the first `all` targets, evenly chosen, to the front.
static void move_to_front(struct orl_heldout *targets, size_t count, size_t all)
{
    for (size_t i = 0; i < count; i++) {
        const size_t from = (2 * i + 1) * all / (2 * count);
        const struct orl_heldout moved = targets[from];
        targets[from] = targets[i];
        targets[i] = moved;
    }
}

static enum orl_result start(struct trim_search *s)
{
    const struct orl_trim_params *p = s->params;
    struct orl_pair_timing timing;
    ORL_TRY(orl_validation_load(s->log, s->scene, 0, p->size_divide, &s->targets));
    s->deciding_count = s->targets.count < DECIDING_MAX ? s->targets.count : DECIDING_MAX;
    s->validation_count = (size_t)p->views < s->deciding_count ? (size_t)p->views : s->deciding_count;
    move_to_front(s->targets.views, s->deciding_count, s->targets.count);
    move_to_front(s->targets.views, s->validation_count, s->deciding_count);
    s->most = has_budget(s) ? (struct orl_score_loss){INFINITY, INFINITY, INFINITY}
                            : (struct orl_score_loss){p->tolerance_db, p->tolerance_ssim, p->worst_db};
    ORL_TRY(orl_point_ranking_make(s->gpu, s->scene, RANKED_VIEWS, p->progress, &s->ranking));
    ORL_TRY(orl_trim_order_photos(s));
    ORL_TRY(orl_trim_state_begin(s, ORL_TRIM_OPTION, &s->first));
    s->now = s->first;
    ORL_TRY(orl_trim_model_open(s, s->first));
    ORL_TRY(orl_trim_measure_all(s, &s->trim->before));
    ORL_TRY(compare(s, s->first, s->first, 1, 0, ROUNDS_OF_FIRST, &timing));
    s->first_ms = timing.ms;
    s->first->step.bytes = model_bytes(s, s->first);
    return ORL_OK;
}

// Fits the method's options at half the size, where a frame takes a quarter of the time, or at the least one that a
// search compares at, and takes them if they are better by the targets that decide.
static enum orl_result tune(struct trim_search *s)
{
    struct orl_search search;
    bool taken;
    const struct orl_trim_params *p = s->params;
    const int divide = TUNED_DIVIDE * p->size_divide;
    const struct orl_search_params params = {
        .size_divide = divide < ORL_SEARCH_DIVIDE_MAX ? divide : ORL_SEARCH_DIVIDE_MAX, .views = TUNED_VIEWS,
        .gain_db = tuned_gain * p->tolerance_db, .budget_s = tuned_time * p->budget_s,
        .progress = p->progress};
    ORL_TRY(orl_search_run(s->gpu, orl_trim_model_of(s->now)->renderer, s->scene, &params, p->start, NULL, &search));
    s->tuned = search.best.params;
    orl_search_finish(&search);
    return try_level(s, options, 0, &taken);
}

enum orl_result orl_trim_search(struct trim_search *s)
{
    ORL_TRY(start(s));
    if (!s->params->keep_options)
        ORL_TRY(tune(s));
    ORL_TRY(climb(s));
    ORL_TRY(make_faster(s));
    ORL_TRY(orl_trim_confirm(s));
    bool slow; // what was timed last had the steps that are taken back now
    return s->trim->undone ? time_whole(s, &slow) : ORL_OK;
}

void orl_trim_search_finish(struct trim_search *s)
{
    while (s->now) {
        struct trim_state *before = s->now->before;
        orl_trim_state_destroy(&s->now);
        s->now = before;
    }
    orl_point_ranking_finish(&s->ranking);
    orl_validation_finish(&s->targets);
    free(s->order);
}
