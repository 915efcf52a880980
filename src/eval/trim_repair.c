// Steps taken back. The validation photographs of a step are few and its loss is small, so that all
// steps together may lose more than they may. What is taken back then need not be the last step: each is left out
// in turn, and the one that mends most for what it saves goes.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "eval/trim_search.h"

enum {
    LOOKED_AT = 16,         // targets that say what a step costs, at most
    PHOTOGRAPHS_DIVIDE = 4, // this part of the removals comes back together
};
// The weight of a frame's time beside bytes, and what every step is worth at least.
static const double weight_of_time = 0.1, min_worth = 1e-3;

// --- history ---

// Makes the states of the steps after this one anew.
static enum orl_result replay(struct trim_search *s, size_t step)
{
    enum orl_result result = ORL_OK;
    size_t photos = s->source.scene->photo_count;
    char what[96];
    for (size_t k = step; result == ORL_OK && k < s->history_count; k++) {
        struct trim_state *next =
            k + 1 < s->history_count ? &s->history[k + 1].state : &s->state;
        free(next->removed);
        result = orl_trim_state_copy(s->source.log, &s->history[k].state, photos, next);
        if (result == ORL_OK)
            orl_trim_apply(s, s->history[k].move, next, what);
    }
    return result;
}

// The report's later steps were taken without this one.
static void report_undone(struct trim_search *s, size_t step)
{
    struct orl_trim *trim = s->trim;
    struct orl_trim_step *undone = &trim->steps[s->history[step].step];
    for (size_t k = step + 1; k < s->history_count; k++) {
        struct orl_trim_step *later = &trim->steps[s->history[k].step];
        later->bytes += undone->saved_bytes;
        later->total_loss_db -= undone->loss_db;
        later->total_loss_ssim -= undone->loss_ssim;
    }
    undone->taken = false;
    trim->undone++;
}

enum orl_result orl_trim_undo(struct trim_search *s, size_t step)
{
    struct trim_past past = s->history[step];
    double slower = past.move ? past.move->measured.slower : 1;
    report_undone(s, step);
    if (past.move)
        past.move->dead = true;
    memmove(&s->history[step], &s->history[step + 1],
            (--s->history_count - step) * sizeof *s->history);
    for (size_t k = step; k < s->history_count; k++)
        s->history[k].slower /= slower;
    s->slower /= slower;
    struct trim_state *same = step < s->history_count ? &s->history[step].state : &s->state;
    free(same->removed);
    *same = past.state;
    return replay(s, step);
}

// --- what a step gives back ---

// Steps that are taken back together: one, or the last so many removals of photographs, of which
// `step` is the first.
struct repair {
    size_t step, photographs; // photographs: 0: one step
    double excess; // what the state without them loses more than it may; see excess_of()
    double worth;  // what they save: shares of bytes, and of a frame's time
};

static bool is_removal(const struct trim_search *s, size_t step)
{
    const struct trim_move *move = s->history[step].move;
    return move && move->part == ORL_TRIM_PHOTOGRAPH;
}

static size_t removals(const struct trim_search *s)
{
    size_t count = 0;
    for (size_t k = 0; k < s->history_count; k++)
        count += is_removal(s, k);
    return count;
}

// The last step of this move: of a part with levels, only the last one can go.
static bool is_last_of_move(const struct trim_search *s, size_t step)
{
    for (size_t k = step + 1; k < s->history_count; k++)
        if (s->history[k].move == s->history[step].move)
            return false;
    return true;
}

static double worth_of(const struct trim_search *s, size_t step)
{
    const struct orl_trim_step *report = &s->trim->steps[s->history[step].step];
    return fmax(report->saved_bytes / s->first_bytes, 0) +
           weight_of_time * fmax(report->saved_ms / s->first_ms, 0) + min_worth;
}

// The state after the history without these steps; its `removed` is owned by the caller.
static enum orl_result state_without(const struct trim_search *s, const struct repair *r,
                                     struct trim_state *state)
{
    char what[96];
    enum orl_result result =
        orl_trim_state_copy(s->source.log, &s->history[r->step].state,
                            s->source.scene->photo_count, state);
    for (size_t k = r->step; result == ORL_OK && k < s->history_count; k++)
        if (r->photographs ? !is_removal(s, k) : k != r->step)
            orl_trim_apply(s, s->history[k].move, state, what);
    return result;
}

// The largest share by which a tolerance is exceeded; 0 or less: none is.
static double excess_of(const struct trim_search *s, double loss_db, double loss_ssim,
                        double worst_db)
{
    const struct orl_trim_params *p = s->params;
    const double least = 1e-3; // a tolerance may be 0
    double excess = (loss_db - p->tolerance_db) / fmax(p->tolerance_db, least);
    excess = fmax(excess, (loss_ssim - p->tolerance_ssim) / fmax(p->tolerance_ssim, least));
    return fmax(excess, (worst_db - p->worst_db) / fmax(p->worst_db, least));
}

// Targets that say what a step costs: all, or the one that loses most and others evenly chosen.
static size_t choose_views(const struct trim_search *s, size_t views[LOOKED_AT])
{
    size_t n = s->targets.count, count = n < LOOKED_AT ? n : LOOKED_AT, worst = 0;
    bool has_worst = false;
    for (size_t i = 1; i < n; i++)
        worst = s->lost_db[i] > s->lost_db[worst] ? i : worst;
    for (size_t i = 0; i < count; i++) {
        views[i] = orl_trim_validation_view(s, i, count);
        has_worst |= views[i] == worst;
    }
    if (!has_worst)
        views[0] = worst;
    return count;
}

// Measures the state without these steps. What views lose that are not looked at is estimated from
// the mean of the others, and their worst loss stays.
static enum orl_result look_at(struct trim_search *s, struct repair *r)
{
    const struct orl_trim *trim = s->trim;
    struct trim_state state = {0};
    struct trim_model *model = NULL;
    size_t views[LOOKED_AT], count = choose_views(s, views);
    double db = trim->before.psnr_db - trim->after.psnr_db, worst = -INFINITY;
    double ssim = trim->before.ssim - trim->after.ssim;
    enum orl_result result = state_without(s, r, &state);
    if (result == ORL_OK)
        result = orl_trim_model_open(&s->source, &state, &model);
    for (size_t v = 0; result == ORL_OK && v < s->targets.count; v++) {
        struct orl_metrics m = {.psnr_db = s->now[v].db};
        bool looked_at = false;
        for (size_t i = 0; i < count; i++)
            looked_at |= views[i] == v;
        if (looked_at)
            result = orl_trim_measure_view(s, model->renderer, &state, v, true, &m);
        if (looked_at) {
            db -= (m.psnr_db - s->now[v].db) / (double)count;
            ssim -= (m.ssim - s->now[v].ssim) / (double)count;
        }
        worst = fmax(worst, s->first_db[v] - m.psnr_db);
    }
    orl_trim_model_close(&model);
    free(state.removed);
    r->excess = excess_of(s, db, ssim, worst);
    return result;
}

// What is within the tolerances for the least worth; else what mends most for its worth.
static bool is_better(const struct repair *a, const struct repair *b, double excess)
{
    bool mends = a->excess <= 0;
    if (mends != (b->excess <= 0))
        return mends;
    return mends ? a->worth < b->worth
                 : (excess - a->excess) / a->worth > (excess - b->excess) / b->worth;
}

static enum orl_result choose(struct trim_search *s, struct repair *best)
{
    const struct orl_trim *trim = s->trim;
    double excess = excess_of(s, trim->before.psnr_db - trim->after.psnr_db,
                              trim->before.ssim - trim->after.ssim, trim->after.worst_loss_db);
    size_t gone = removals(s), together = (gone + PHOTOGRAPHS_DIVIDE - 1) / PHOTOGRAPHS_DIVIDE;
    size_t last = 0;
    enum orl_result result = ORL_OK;
    *best = (struct repair){.excess = INFINITY, .worth = 1};
    for (size_t k = s->history_count; result == ORL_OK && k-- > 0;) {
        bool removal = is_removal(s, k);
        struct repair r = {.step = k};
        last += removal;
        if (!s->history[k].move || !is_last_of_move(s, k) || (removal && last != together))
            continue;
        r.photographs = removal ? together : 0;
        r.worth = worth_of(s, k) * (double)(removal ? together : 1);
        result = look_at(s, &r);
        orl_logf(s->source.log, ORL_LOG_DEBUG, "without %s: exceeds by %.2f, worth %.3f",
                 trim->steps[s->history[k].step].what, r.excess, r.worth);
        if (result == ORL_OK && is_better(&r, best, excess))
            *best = r;
    }
    return result;
}

// The step that made a frame longest.
static struct repair slowest(const struct trim_search *s)
{
    struct repair best = {.step = s->history_count - 1};
    double most = 0;
    for (size_t k = 0; k < s->history_count; k++) {
        double ms = -s->trim->steps[s->history[k].step].saved_ms;
        if (s->history[k].move && is_last_of_move(s, k) && ms > most) {
            most = ms;
            best.step = k;
        }
    }
    return best;
}

// --- taking it back ---

static enum orl_result take_back(struct trim_search *s, const struct repair *r)
{
    enum orl_result result = ORL_OK;
    if (!s->history[r->step].move) { // tuned options, which only all others may leave
        struct trim_past *past = &s->history[--s->history_count];
        s->trim->steps[past->step].taken = false;
        s->trim->undone++;
        free(s->state.removed);
        s->state = past->state;
        s->slower = past->slower;
        return ORL_OK;
    }
    if (!r->photographs)
        return orl_trim_undo(s, r->step);
    size_t back = r->photographs;
    for (size_t k = s->history_count; result == ORL_OK && back > 0 && k-- > 0;)
        if (is_removal(s, k)) {
            result = orl_trim_undo(s, k);
            back--;
        }
    return result;
}

enum orl_result orl_trim_repair(struct trim_search *s, const struct trim_check *check)
{
    struct repair repair = {.step = 0};
    enum orl_result result = ORL_OK;
    bool tuned_alone = s->history_count == 1 && !s->history[0].move;
    if (!tuned_alone && check->lost)
        result = choose(s, &repair);
    else if (!tuned_alone)
        repair = slowest(s);
    if (result == ORL_OK)
        result = take_back(s, &repair);
    orl_trim_model_close(&s->model);
    return result == ORL_OK ? orl_trim_model_open(&s->source, &s->state, &s->model) : result;
}
