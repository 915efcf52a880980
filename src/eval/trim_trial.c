// Trials of states: what they lose against the whole scene, and whether they are taken.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "eval/trim_search.h"

// --- figures of a state ---

// PSNR and SSIM of one target in the state, the target being left out.
static enum orl_result measure_view(struct trim_search *s, const struct trim_model *model,
                                    struct trim_standing *standing, size_t view)
{
    struct trim_score *score = &standing->score[view];
    if (orl_progress_cancelled(s->params->progress))
        return ORL_ERR_CANCELLED;
    return orl_validation_compare(s->source.log, model->renderer, &s->targets, view, &standing->state.render,
                                  standing->state.removed, &score->db, &score->ssim);
}

double orl_trim_model_bytes(const struct trim_search *s, const struct trim_model *model,
                            const struct trim_state *state)
{
    double left = (double)(s->targets.count - state->removed_count) / (double)s->targets.count;
    return (double)model->point_bytes + (double)model->photo_bytes * left;
}

// The losses from one score of the targets to another, over those that have both.
static struct trim_loss loss_between(const struct trim_search *s, const struct trim_score *before,
                                     const struct trim_score *after)
{
    struct trim_loss loss = {.worst_db = -INFINITY};
    double count = 0;
    for (size_t i = 0; i < s->targets.count; i++) {
        if (isnan(before[i].db) || isnan(after[i].db))
            continue;
        loss.db += before[i].db - after[i].db;
        loss.ssim += before[i].ssim - after[i].ssim;
        loss.worst_db = fmax(loss.worst_db, before[i].db - after[i].db);
        count++;
    }
    loss.db /= fmax(count, 1);
    loss.ssim /= fmax(count, 1);
    return loss;
}

void orl_trim_standing_finish(struct trim_standing *standing)
{
    free(standing->state.removed);
    free(standing->score);
    *standing = (struct trim_standing){0};
}

// --- a trial ---

enum orl_result orl_trim_trial_begin(struct trim_search *s, enum orl_trim_part part,
                                     struct trim_trial *t)
{
    *t = (struct trim_trial){.part = part, .now.slower = 1};
    t->now.score = orl_array(s->source.log, s->targets.count, sizeof *t->now.score);
    ORL_TRY_MEMORY(t->now.score);
    for (size_t i = 0; i < s->targets.count; i++)
        t->now.score[i] = (struct trim_score){NAN, NAN};
    return orl_trim_state_copy(s->source.log, &s->now.state, s->source.scene->photo_count, &t->now.state);
}

void orl_trim_trial_end(struct trim_trial *t)
{
    orl_trim_model_close(&t->own);
    orl_trim_standing_finish(&t->now);
}

const struct trim_model *orl_trim_trial_model(const struct trim_search *s, const struct trim_trial *t)
{
    return t->own ? t->own : s->model;
}

// Measures the i-th of the targets that decide, unless that is done.
static enum orl_result measure_deciding(struct trim_search *s, struct trim_trial *t, size_t i)
{
    size_t view = orl_trim_validation_view(s, i, s->deciding_count);
    return isnan(t->now.score[view].db) ? measure_view(s, orl_trim_trial_model(s, t), &t->now, view)
                                        : ORL_OK;
}

static void set_losses(struct trim_search *s, struct trim_trial *t)
{
    t->step = loss_between(s, s->now.score, t->now.score);
    t->now.loss = loss_between(s, s->first, t->now.score);
}

// Whether a few views leave it open that all that decide allow the step.
static bool is_open(const struct trim_search *s, const struct trim_trial *t)
{
    struct trim_trial half = *t;
    half.now.loss.db /= t->now.loss.db > 0 ? 2 : 1;
    half.now.loss.ssim /= t->now.loss.ssim > 0 ? 2 : 1;
    return orl_trim_trial_fits(s, &half, 1);
}

enum orl_result orl_trim_trial_measure(struct trim_search *s, struct trim_trial *t, bool shares)
{
    ORL_TRY(shares ? ORL_OK : orl_trim_model_open(&s->source, &t->now.state, &t->own));
    t->now.bytes = orl_trim_model_bytes(s, orl_trim_trial_model(s, t), &t->now.state);
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

bool orl_trim_trial_fits(const struct trim_search *s, const struct trim_trial *t, double share)
{
    const struct trim_loss *now = &s->now.loss, *all = &s->most;
    const struct trim_loss most = {.db = fmin(now->db + share * (all->db - now->db), all->db),
                                   .ssim = fmin(now->ssim + share * (all->ssim - now->ssim), all->ssim),
                                   .worst_db = all->worst_db};
    return is_within(&t->now.loss, &most);
}

// Adds it to the report.
static enum orl_result note(struct trim_search *s, const struct trim_trial *t)
{
    struct orl_trim *trim = s->trim;
    ORL_TRY(ORL_GROW(s->source.log, trim->steps, trim->step_capacity, trim->step_count));
    struct orl_trim_step *step = &trim->steps[trim->step_count++];
    *step = (struct orl_trim_step){
        .part = t->part, .loss_db = t->step.db, .loss_ssim = t->step.ssim, .taken = true,
        .bytes = t->now.bytes, .ms = s->first_ms * s->now.slower * t->now.slower,
        .total_loss_db = t->now.loss.db, .total_loss_ssim = t->now.loss.ssim};
    memcpy(step->what, t->what, sizeof step->what);
    if (s->params->on_step)
        s->params->on_step(s->params->priv, step);
    return ORL_OK;
}

enum orl_result orl_trim_trial_take(struct trim_search *s, struct trim_trial *t)
{
    ORL_TRY(note(s, t));
    ORL_TRY(ORL_GROW(s->source.log, s->history, s->history_capacity, s->history_count));
    s->history[s->history_count++] = s->now;
    t->now.slower *= s->now.slower;
    s->now = t->now;
    t->now = (struct trim_standing){0};
    if (t->own) {
        orl_trim_model_close(&s->model);
        s->model = t->own;
        t->own = NULL;
    }
    return ORL_OK;
}

// --- all targets ---

enum orl_result orl_trim_measure_all(struct trim_search *s, bool first,
                                     struct orl_trim_figures *figures)
{
    double n = (double)s->targets.count;
    *figures = (struct orl_trim_figures){.frame_ms = figures->frame_ms};
    for (size_t i = 0; i < s->targets.count; i++) {
        orl_progress_report(s->params->progress, first ? "whole scene" : "trimmed scene",
                            (double)i, n, NULL);
        ORL_TRY(measure_view(s, s->model, &s->now, i));
        if (first)
            s->first[i] = s->now.score[i];
        figures->psnr_db += s->now.score[i].db / n;
        figures->ssim += s->now.score[i].ssim / n;
    }
    s->now.loss = loss_between(s, s->first, s->now.score);
    figures->worst_loss_db = s->now.loss.worst_db;
    figures->points = s->model->scene.points.count;
    figures->photographs = s->targets.count - s->now.state.removed_count;
    return ORL_OK;
}

static enum orl_result take_back(struct trim_search *s)
{
    size_t step = --s->history_count;
    s->trim->steps[step].taken = false;
    s->trim->undone++;
    orl_trim_standing_finish(&s->now);
    s->now = s->history[step];
    orl_trim_model_close(&s->model);
    return orl_trim_model_open(&s->source, &s->now.state, &s->model);
}

enum orl_result orl_trim_confirm(struct trim_search *s)
{
    enum orl_result result = orl_trim_measure_all(s, false, &s->trim->after);
    while (result == ORL_OK && s->history_count > 0 && !is_within(&s->now.loss, &s->most)) {
        result = take_back(s);
        ORL_THEN(result, orl_trim_measure_all(s, false, &s->trim->after));
    }
    return result;
}
