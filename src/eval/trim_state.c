// States of a trimmed scene: the models that they are drawn with, what they lose against the whole
// scene, and which are taken.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
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

// Draws a small frame, since depth maps and masks of photographs take memory only once a method has
// asked for them.
static enum orl_result draw_first_frame(const struct trim_search *s, const struct trim_state *state)
{
    enum { SIDE = 64 };
    const struct orl_scene *scene = &state->model->scene;
    size_t photo = 0;
    while (photo + 1 < scene->photo_count && (scene->photos[photo].test || state->removed[photo]))
        photo++;
    struct orl_view view = scene->photos[photo].view;
    struct orl_render_params render = state->render;
    render.leave_out = ~0u;
    view.camera = orl_camera_resized(&view.camera, SIDE, SIDE);
    ORL_TRY(orl_renderer_draw(state->model->renderer, &view, &render, state->removed, NULL));
    return orl_gpu_finish(s->gpu);
}

static void close_model(struct trim_state *state)
{
    if (!state->model)
        return;
    orl_renderer_destroy(&state->model->renderer);
    orl_points_finish(&state->model->points);
    free(state->model);
    state->model = NULL;
}

enum orl_result orl_trim_model_open(const struct trim_search *s, struct trim_state *state)
{
    size_t points = 0, photos = 0, all = s->scene->points.count;
    size_t count = (size_t)(orl_trim_point_shares[state->level[ORL_TRIM_POINTS]] * (double)all + 0.5);
    struct trim_model *model = orl_array(s->log, 1, sizeof *model);
    state->model = model;
    ORL_TRY_MEMORY(model);
    model->scene = *s->scene;
    model->scene.defaults = orl_trim_defaults(s, state);
    enum orl_result result = ORL_OK;
    if (count < all) {
        result = orl_points_thin_out(s->log, &s->scene->points, s->ranking.order, count, &model->points);
        model->scene.points = model->points;
    }
    orl_trim_count_bytes(s->gpu, &points, &photos);
    ORL_THEN(result, orl_renderer_create(s->gpu, &model->scene, NULL, &model->renderer));
    ORL_THEN(result, draw_first_frame(s, state));
    orl_trim_count_bytes(s->gpu, &model->point_bytes, &model->photo_bytes);
    model->point_bytes -= points;
    model->photo_bytes -= photos;
    if (result != ORL_OK)
        close_model(state);
    return result;
}

const struct trim_model *orl_trim_model_of(const struct trim_state *state)
{
    while (!state->model)
        state = state->before;
    return state->model;
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
    const size_t targets = s->targets.count, photos = s->scene->photo_count;
    struct trim_state *state = orl_array(
        s->log, 1, sizeof *state + targets * sizeof *state->score + photos * sizeof *state->removed);
    *out = state;
    ORL_TRY_MEMORY(state);
    *state = s->now ? *s->now : (struct trim_state){.render = s->params->start->params, .slower = 1};
    state->before = s->now;
    state->model = NULL;
    state->shares = false;
    state->step = (struct orl_trim_step){.part = part};
    state->removed = (bool *)(state->score + targets);
    if (s->now)
        memcpy(state->removed, s->now->removed, photos * sizeof *state->removed);
    for (size_t i = 0; i < targets; i++)
        state->score[i] = (struct trim_score){NAN, NAN};
    return ORL_OK;
}

void orl_trim_state_destroy(struct trim_state **state)
{
    if (*state)
        close_model(*state);
    free(*state);
    *state = NULL;
}

// --- figures of a state ---

// PSNR and SSIM of one target in the state, the target being left out.
static enum orl_result measure_view(struct trim_search *s, struct trim_state *state, size_t view)
{
    struct trim_score *score = &state->score[view];
    if (orl_progress_cancelled(s->params->progress))
        return ORL_ERR_CANCELLED;
    return orl_validation_compare(s->log, orl_trim_model_of(state)->renderer, &s->targets, view, &state->render,
                                  state->removed, &score->db, &score->ssim);
}

// The losses from one state to another, over the targets that both have.
static struct trim_loss loss_between(const struct trim_search *s, const struct trim_state *before,
                                     const struct trim_state *after)
{
    struct trim_loss loss = {.worst_db = -INFINITY};
    double count = 0;
    for (size_t i = 0; i < s->targets.count; i++) {
        const struct trim_score *a = &before->score[i], *b = &after->score[i];
        if (isnan(a->db) || isnan(b->db))
            continue;
        loss.db += a->db - b->db;
        loss.ssim += a->ssim - b->ssim;
        loss.worst_db = fmax(loss.worst_db, a->db - b->db);
        count++;
    }
    loss.db /= fmax(count, 1);
    loss.ssim /= fmax(count, 1);
    return loss;
}

// Measures the i-th of the targets that decide, unless that is done.
static enum orl_result measure_deciding(struct trim_search *s, struct trim_state *t, size_t i)
{
    size_t view = orl_trim_validation_view(s, i, s->deciding_count);
    return isnan(t->score[view].db) ? measure_view(s, t, view) : ORL_OK;
}

static void set_losses(const struct trim_search *s, struct trim_state *t)
{
    const struct trim_loss step = loss_between(s, t->before, t);
    t->step.loss_db = step.db;
    t->step.loss_ssim = step.ssim;
    t->loss = loss_between(s, s->first, t);
}

// Whether a few views leave it open that all that decide allow the step.
static bool is_open(const struct trim_search *s, const struct trim_state *t)
{
    struct trim_loss half = t->loss;
    half.db /= half.db > 0 ? 2 : 1;
    half.ssim /= half.ssim > 0 ? 2 : 1;
    return orl_trim_fits(s, &half, 1);
}

enum orl_result orl_trim_measure(struct trim_search *s, struct trim_state *t)
{
    if (!t->shares)
        ORL_TRY(orl_trim_model_open(s, t));
    t->step.bytes = orl_trim_model_bytes(s, t);
    for (size_t i = 0; i < s->validation_count; i++)
        ORL_TRY(measure_deciding(s, t, (2 * i + 1) * s->deciding_count / (2 * s->validation_count)));
    set_losses(s, t);
    for (size_t i = 0; is_open(s, t) && i < s->deciding_count; i++)
        ORL_TRY(measure_deciding(s, t, i));
    set_losses(s, t);
    return ORL_OK;
}

static bool is_within(const struct trim_loss *loss, const struct trim_loss *most)
{
    return loss->db <= most->db && loss->ssim <= most->ssim && loss->worst_db <= most->worst_db;
}

bool orl_trim_fits(const struct trim_search *s, const struct trim_loss *loss, double share)
{
    const struct trim_loss *now = &s->now->loss, *all = &s->most;
    const struct trim_loss most = {.db = fmin(now->db + share * (all->db - now->db), all->db),
                                   .ssim = fmin(now->ssim + share * (all->ssim - now->ssim), all->ssim),
                                   .worst_db = all->worst_db};
    return is_within(loss, &most);
}

enum orl_result orl_trim_take(struct trim_search *s, struct trim_state **trial)
{
    struct orl_trim *trim = s->trim;
    struct trim_state *t = *trial;
    ORL_TRY(ORL_GROW(s->log, trim->steps, trim->step_capacity, trim->step_count));
    t->step.taken = true;
    t->step.ms = s->first_ms * t->slower;
    t->step.total_loss_db = t->loss.db;
    t->step.total_loss_ssim = t->loss.ssim;
    trim->steps[trim->step_count++] = t->step;
    if (s->params->on_step)
        s->params->on_step(s->params->priv, &t->step);
    if (t->model)
        orl_trim_models_close(t->before);
    s->now = t;
    *trial = NULL;
    return ORL_OK;
}

// --- all targets ---

enum orl_result orl_trim_measure_all(struct trim_search *s, struct orl_trim_figures *figures)
{
    const char *what = s->trim->step_count ? "trimmed scene" : "whole scene";
    double n = (double)s->targets.count;
    *figures = (struct orl_trim_figures){.frame_ms = figures->frame_ms};
    for (size_t i = 0; i < s->targets.count; i++) {
        orl_progress_report(s->params->progress, what, (double)i, n, NULL);
        ORL_TRY(measure_view(s, s->now, i));
        figures->psnr_db += s->now->score[i].db / n;
        figures->ssim += s->now->score[i].ssim / n;
    }
    s->now->loss = loss_between(s, s->first, s->now);
    figures->worst_loss_db = s->now->loss.worst_db;
    figures->points = orl_trim_model_of(s->now)->scene.points.count;
    figures->photographs = s->targets.count - s->now->removed_count;
    return ORL_OK;
}

static enum orl_result take_back(struct trim_search *s)
{
    struct trim_state *last = s->now;
    bool own = last->model != NULL;
    s->now = last->before;
    s->trim->steps[s->trim->step_count - ++s->trim->undone].taken = false;
    orl_trim_state_destroy(&last);
    return own ? orl_trim_model_open(s, s->now) : ORL_OK;
}

enum orl_result orl_trim_confirm(struct trim_search *s)
{
    enum orl_result result = orl_trim_measure_all(s, &s->trim->after);
    while (result == ORL_OK && s->now != s->first && !is_within(&s->now->loss, &s->most)) {
        result = take_back(s);
        ORL_THEN(result, orl_trim_measure_all(s, &s->trim->after));
    }
    return result;
}
