// All training photographs have the last word on the steps that were taken. Where they lose more
// than those few photographs said, photographs that a view needs come back, or steps are taken back
// that give much for few bytes (trim_repair.c).
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "eval/trim_search.h"

// Photographs that may be put back for a view, the nearest ones; further ones show less of it.
enum { PUT_BACK_TRIED = 6 };

// --- measuring ---

static void add_figures(const struct trim_search *s, struct orl_trim_figures *figures)
{
    double n = (double)s->targets.count;
    *figures = (struct orl_trim_figures){.worst_loss_db = -INFINITY,
                                         .frame_ms = figures->frame_ms};
    for (size_t i = 0; i < s->targets.count; i++) {
        figures->psnr_db += s->now[i].db / n;
        figures->ssim += s->now[i].ssim / n;
        figures->worst_loss_db = fmax(figures->worst_loss_db, s->first_db[i] - s->now[i].db);
    }
    figures->points = s->model->scene.points.count;
    figures->photographs = s->targets.count - s->state.removed_count;
    figures->point_bytes = s->model->point_bytes;
    figures->photo_bytes = (size_t)orl_trim_model_bytes(s, s->model, &s->state) -
                           s->model->point_bytes;
}

enum orl_result orl_trim_measure_all(struct trim_search *s, bool first,
                                     struct orl_trim_figures *figures)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < s->targets.count; i++) {
        struct orl_metrics m;
        orl_progress_report(s->params->progress, first ? "whole scene" : "trimmed scene",
                            (double)i, (double)s->targets.count, NULL);
        result = orl_trim_measure_view(s, s->model->renderer, &s->state, i, true, &m);
        s->now[i] = (struct trim_score){m.psnr_db, m.ssim};
        s->first_db[i] = first ? m.psnr_db : s->first_db[i];
        s->lost_db[i] = s->first_db[i] - m.psnr_db;
    }
    add_figures(s, figures);
    return result;
}

// --- whether it is within the tolerances ---

// Whether steps have to be taken back.
static bool is_broken(const struct trim_check *check)
{
    return check->lost || (check->slow && check->kind == TRIM_CONFIRM_LAST);
}

enum orl_result orl_trim_check(struct trim_search *s, struct trim_check *check)
{
    const struct orl_trim_params *p = s->params;
    const struct orl_trim_figures *before = &s->trim->before, *after = &s->trim->after;
    enum orl_result result = orl_trim_measure_all(s, false, &s->trim->after);
    if (result == ORL_OK && check->kind != TRIM_CONFIRM_LOSSES)
        result = orl_trim_time_whole(s, &check->slow);
    check->lost = !orl_trim_has_budget(s) &&
                  (before->psnr_db - after->psnr_db > p->tolerance_db ||
                   before->ssim - after->ssim > p->tolerance_ssim ||
                   after->worst_loss_db > p->worst_db);
    return result;
}

// --- putting photographs back ---

// Index of the step since the last confirmation that removed this target's photograph;
// s->history_count: none.
static size_t removal_of(const struct trim_search *s, size_t target)
{
    for (size_t k = s->confirmed; k < s->history_count; k++)
        if (s->history[k].move && s->history[k].move->part == ORL_TRIM_PHOTOGRAPH &&
            s->history[k].move->index == target)
            return k;
    return s->history_count;
}

// The nearest photographs to a view that were removed since the last confirmation.
static size_t nearest_removed(const struct trim_search *s, size_t view,
                              size_t targets[PUT_BACK_TRIED])
{
    double distance[PUT_BACK_TRIED];
    size_t count = 0;
    for (size_t i = 0; i < s->targets.count; i++) {
        double d, angle;
        if (i == view || removal_of(s, i) == s->history_count)
            continue;
        orl_validation_apart(s->source.scene, s->targets.views[view].photo,
                             s->targets.views[i].photo, &d, &angle);
        d += angle;
        size_t at = count < PUT_BACK_TRIED ? count : PUT_BACK_TRIED - 1;
        if (count == PUT_BACK_TRIED && d >= distance[at])
            continue;
        count += count < PUT_BACK_TRIED;
        for (; at > 0 && d < distance[at - 1]; at--) {
            distance[at] = distance[at - 1];
            targets[at] = targets[at - 1];
        }
        distance[at] = d;
        targets[at] = i;
    }
    return count;
}

// Puts photographs back until the view loses no more than it may: each time the one of the nearest
// that helps it most. Stops when none helps.
static enum orl_result mend_view(struct trim_search *s, size_t view, bool *mended)
{
    enum orl_result result = ORL_OK;
    bool helps = true;
    while (result == ORL_OK && helps && s->lost_db[view] > s->params->worst_db) {
        size_t targets[PUT_BACK_TRIED], best = 0;
        size_t count = nearest_removed(s, view, targets);
        struct trim_score most = s->now[view];
        helps = false;
        for (size_t i = 0; result == ORL_OK && i < count; i++) {
            struct orl_metrics m;
            bool *removed = &s->state.removed[s->targets.views[targets[i]].photo];
            *removed = false;
            result = orl_trim_measure_view(s, s->model->renderer, &s->state, view, true, &m);
            *removed = true;
            if (result == ORL_OK && m.psnr_db > most.db) {
                helps = true;
                best = targets[i];
                most = (struct trim_score){m.psnr_db, m.ssim};
            }
        }
        if (result == ORL_OK && helps)
            result = orl_trim_undo(s, removal_of(s, best));
        if (result == ORL_OK && helps) {
            s->now[view] = most;
            s->lost_db[view] = s->first_db[view] - most.db;
            *mended = true;
        }
    }
    return result;
}

// Puts back the photographs that views need which lose more than one may.
static enum orl_result mend(struct trim_search *s, struct trim_check *check)
{
    enum orl_result result = ORL_OK;
    bool mended = true;
    while (result == ORL_OK && mended && check->lost &&
           s->trim->after.worst_loss_db > s->params->worst_db) {
        mended = false;
        for (size_t i = 0; result == ORL_OK && i < s->targets.count; i++)
            result = mend_view(s, i, &mended);
        if (result == ORL_OK && mended) // other views change, too
            result = orl_trim_check(s, check);
    }
    return result;
}

// --- the whole ---

// What the steps that are kept really cost, over all training photographs, counts from now on.
static void settle(struct trim_search *s, const struct trim_check *check)
{
    const struct orl_trim *trim = s->trim;
    if (check->kind != TRIM_CONFIRM_LOSSES)
        s->slower = trim->after.frame_ms / trim->before.frame_ms;
    s->slow = check->slow && check->kind == TRIM_CONFIRM_TIMED;
    s->total_loss_db = trim->before.psnr_db - trim->after.psnr_db;
    s->total_loss_ssim = trim->before.ssim - trim->after.ssim;
    s->bytes = orl_trim_model_bytes(s, s->model, &s->state);
    s->file_bytes = (double)orl_trim_photo_file_bytes(&s->source, s->model->scene.dir,
                                                      s->state.removed);
    s->version++;
    s->confirmed = s->history_count;
    // What steps wait for was estimated step by step: they may be measured again.
    for (size_t i = 0; i < s->move_count; i++)
        s->moves[i].slow = false;
    orl_trim_make_room(s);
}

enum orl_result orl_trim_confirm(struct trim_search *s, enum trim_confirmation kind)
{
    struct trim_check check = {.kind = kind};
    enum orl_result result = orl_trim_check(s, &check);
    size_t steps = s->history_count;
    if (result == ORL_OK)
        result = mend(s, &check);
    while (result == ORL_OK && is_broken(&check) && s->history_count > 0) {
        result = orl_trim_repair(s, &check);
        if (result == ORL_OK)
            result = orl_trim_check(s, &check);
    }
    if (result != ORL_OK)
        return result;
    if (s->history_count < steps)
        s->changed = s->version + 1;
    settle(s, &check);
    return ORL_OK;
}
