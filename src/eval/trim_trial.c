// Trials of single steps: what a step costs and saves, and whether it is taken.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "eval/trim_search.h"

// Losses below this are noise. Time and files decide between steps that save as many bytes on the
// device: a time is measured with noise, and a pass that goes would use up the tolerance.
static const double min_loss_db = 0.002, weight_of_time = 0.03, weight_of_files = 0.03;
// The weight of time while a frame takes too long. What saves time at next to no loss is taken at
// once; what costs more comes after what makes the model smaller, which mostly makes it faster.
static const double weight_of_waiting = 0.3;
// Views beside a photograph that goes may change by as much as renderings there are wrong anyway.
static const double between_most_db = 3;
// A step is taken when no other promises more than its own gain divided by this.
static const double good_enough = 0.8;
// A step that lost too much is tried again when steps have gained this share of the tolerance.
static const double min_room = 0.1;
// Tuned options are chosen by six photographs: at most so many.
enum { TUNED_JUDGES = 32 };

// A step on trial.
struct trial {
    struct trim_move *move;
    char what[96];
    struct trim_state state;
    struct trim_model *own; // NULL: the search's model serves
    double bytes, file_bytes;
};

// --- figures of a state ---

enum orl_result orl_trim_measure_view(struct trim_search *s, struct orl_renderer *renderer,
                                      const struct trim_state *state, size_t view,
                                      bool brief, struct orl_metrics *metrics)
{
    memset(metrics, 0, sizeof *metrics);
    if (orl_progress_cancelled(s->params->progress))
        return ORL_ERR_CANCELLED;
    return orl_validation_compare(s->source.log, renderer, &s->targets, view, &state->render,
                                  state->removed, brief, metrics);
}

double orl_trim_model_bytes(const struct trim_search *s, const struct trim_model *model,
                            const struct trim_state *state)
{
    double left = (double)(s->targets.count - state->removed_count) / (double)s->targets.count;
    return (double)model->point_bytes + (double)model->photo_bytes * left;
}

// --- measuring a step ---

static enum orl_result begin(struct trim_search *s, struct trim_move *move, struct trial *t)
{
    bool shares = move->part == ORL_TRIM_PHOTOGRAPH ||
                  (move->part == ORL_TRIM_OPTION && !orl_trim_redraws_depth(move));
    *t = (struct trial){.move = move};
    enum orl_result result =
        orl_trim_state_copy(s->source.log, &s->state, s->source.scene->photo_count, &t->state);
    if (result == ORL_OK)
        orl_trim_apply(s, move, &t->state, t->what);
    if (result == ORL_OK && !shares)
        result = orl_trim_model_open(&s->source, &t->state, &t->own);
    if (result != ORL_OK)
        return result;
    const struct trim_model *model = shares ? s->model : t->own;
    t->bytes = orl_trim_model_bytes(s, model, &t->state);
    t->file_bytes = (double)orl_trim_photo_file_bytes(&s->source, model->scene.dir,
                                                      t->state.removed);
    return ORL_OK;
}

static void end(struct trial *t)
{
    orl_trim_model_close(&t->own);
    free(t->state.removed);
}

static bool is_local(const struct trial *t)
{
    return t->move->part == ORL_TRIM_PHOTOGRAPH;
}

static enum orl_result measure_one(struct trim_search *s, const struct trial *t, size_t view,
                                   struct trim_score *score)
{
    struct orl_metrics now, then;
    enum orl_result result = ORL_OK;
    if (isnan(s->now[view].db)) {
        result = orl_trim_measure_view(s, s->model->renderer, &s->state, view, true, &now);
        s->now[view] = (struct trim_score){result == ORL_OK ? now.psnr_db : NAN, now.ssim};
        if (result == ORL_OK)
            s->lost_db[view] = s->first_db[view] - now.psnr_db;
    }
    if (result == ORL_OK)
        result = orl_trim_measure_view(s, t->own ? t->own->renderer : s->model->renderer,
                                       &t->state, view, true, &then);
    if (result == ORL_OK)
        *score = (struct trim_score){then.psnr_db, then.ssim};
    return result;
}

static enum orl_result draw_srgb(struct trim_search *s, const struct orl_view *view,
                                 const struct trim_state *state, const bool *removed,
                                 struct orl_image *picture)
{
    struct orl_frame frame = {0};
    struct orl_render_params render = state->render;
    render.leave_out = ~0u;
    enum orl_result result =
        orl_renderer_draw(s->model->renderer, view, &render, removed, &frame);
    if (result == ORL_OK)
        result = orl_tone_srgb(s->source.log, &frame.color, picture);
    orl_frame_finish(&frame);
    return result;
}

// How far a view half way to a neighbour changes when photographs go, in dB of PSNR: their squared
// difference adds to the squared error that a rendering there has anyway, which is taken to be that
// of the photograph's own view.
static enum orl_result between_loss(struct trim_search *s, const struct trim_state *state,
                                    size_t target, size_t other, double *loss_db)
{
    const struct orl_heldout *at = &s->targets.views[target];
    const struct orl_view view =
        orl_view_interpolate(&at->view, &s->targets.views[other].view, 0.5);
    struct orl_image with = {0}, without = {0};
    enum orl_result result =
        draw_srgb(s, &view, &s->state, s->first_state.removed, &with);
    if (result == ORL_OK)
        result = draw_srgb(s, &view, state, state->removed, &without);
    if (result == ORL_OK) {
        double change_db = orl_metrics_psnr_db(&with, &without);
        *loss_db =
            10 * log10(1 + pow(10, 0.1 * (s->first_db[target] - change_db)));
    }
    orl_image_finish(&with);
    orl_image_finish(&without);
    return result;
}

// No training photograph judges the place of a photograph that goes: that it is left out there is a
// matter of course. The views beside it do, compared with renderings from all photographs.
enum orl_result orl_trim_measure_between(struct trim_search *s, size_t target,
                                         const struct trim_state *state, struct trim_measured *m,
                                         bool *stays)
{
    size_t count = s->near_count < TRIM_BETWEEN ? s->near_count : TRIM_BETWEEN;
    enum orl_result result = ORL_OK;
    m->between_db = m->beside_db = 0;
    *stays = false; // whatever the other views say
    for (size_t i = 0; result == ORL_OK && i < count && !*stays; i++) {
        double loss = 0;
        result = between_loss(s, state, target, s->nearest[target][i], &loss);
        m->between_db = fmax(m->between_db, loss);
        *stays = loss > between_most_db && !orl_trim_has_budget(s);
        m->beside_db += loss / (double)(count * s->targets.count);
    }
    return result;
}

// --- judging it ---

// Whether the photograph of this target is one of those that the view is painted from.
static bool is_near(const struct trim_search *s, size_t view, size_t target)
{
    for (size_t k = 0; k < s->near_count; k++)
        if (s->nearest[view][k] == target)
            return true;
    return false;
}

// Loss of a view by the step: measured, or the mean where the step changes all views. after: the
// view's score then; NAN: it has to be measured.
static double view_loss(const struct trim_search *s, const struct trial *t, size_t view,
                        struct trim_score *after)
{
    const struct trim_measured *m = &t->move->measured;
    bool changed = !is_local(t) || is_near(s, view, t->move->index);
    *after = changed ? (struct trim_score){NAN, NAN} : s->now[view];
    for (size_t k = 0; k < m->view_count; k++)
        if (m->views[k] == view) {
            *after = m->score[k];
            return s->now[view].db - m->score[k].db;
        }
    return is_local(t) ? 0 : m->loss_db;
}

bool orl_trim_has_budget(const struct trim_search *s)
{
    return s->params->max_bytes || s->params->max_frame_ms > 0;
}

// The most that a training photograph has lost after the step.
static double worst_loss(const struct trim_search *s, const struct trial *t)
{
    double worst = -INFINITY;
    struct trim_score after;
    for (size_t i = 0; i < s->targets.count; i++)
        worst = fmax(worst, s->lost_db[i] + view_loss(s, t, i, &after));
    return worst;
}

static bool is_good(const struct trim_search *s, const struct trial *t)
{
    const struct trim_measured *m = &t->move->measured;
    if (orl_trim_has_budget(s))
        return true;
    return s->total_loss_db + m->loss_db <= s->params->tolerance_db &&
           s->total_loss_ssim + m->loss_ssim <= s->params->tolerance_ssim &&
           worst_loss(s, t) <= s->params->worst_db && m->between_db <= between_most_db;
}

// --- measuring it ---

static enum orl_result measure_time(struct trim_search *s, const struct trial *t)
{
    const struct trim_drawn trial = {t->own ? t->own->renderer : s->model->renderer, &t->state};
    return orl_trim_time_trial(s, &trial, &t->move->measured);
}

// Measures m->views. The losses are sums.
static enum orl_result measure_views(struct trim_search *s, const struct trial *t)
{
    struct trim_measured *m = &t->move->measured;
    enum orl_result result = ORL_OK;
    m->loss_db = m->loss_ssim = 0;
    for (size_t i = 0; result == ORL_OK && i < m->view_count; i++) {
        result = measure_one(s, t, m->views[i], &m->score[i]);
        m->before[i] = s->now[m->views[i]];
        m->loss_db += m->before[i].db - m->score[i].db;
        m->loss_ssim += m->before[i].ssim - m->score[i].ssim;
    }
    return result;
}

// By `count` targets, evenly chosen.
static enum orl_result measure_global(struct trim_search *s, const struct trial *t, size_t count)
{
    struct trim_measured *m = &t->move->measured;
    m->view_count = count < TRIM_VIEWS_MAX ? count : TRIM_VIEWS_MAX;
    for (size_t i = 0; i < m->view_count; i++)
        m->views[i] = orl_trim_validation_view(s, i, m->view_count);
    enum orl_result result = measure_views(s, t);
    m->loss_db /= (double)m->view_count;
    m->loss_ssim /= (double)m->view_count;
    return result;
}

// By the targets that stand nearest to the photograph that goes.
static enum orl_result measure_local(struct trim_search *s, const struct trial *t)
{
    struct trim_measured *m = &t->move->measured;
    bool stays = false;
    enum orl_result result = orl_trim_measure_between(s, t->move->index, &t->state, m, &stays);
    m->view_count = stays ? 0 : s->near_count;
    for (size_t i = 0; i < m->view_count; i++)
        m->views[i] = s->nearest[t->move->index][i];
    if (result == ORL_OK)
        result = measure_views(s, t);
    m->loss_db /= (double)s->targets.count;
    m->loss_ssim /= (double)s->targets.count;
    return result;
}

// Whether the step is within the tolerances with half of its losses.
static bool is_nearly_good(const struct trim_search *s, const struct trial *t)
{
    struct trim_move half = *t->move;
    struct trial other = *t;
    half.measured.loss_db /= 2;
    half.measured.loss_ssim /= 2;
    other.move = &half;
    return is_good(s, &other);
}

// True if the few validation photographs refuse a step on average that others may allow: all
// targets decide then.
static bool is_doubtful(const struct trim_search *s, const struct trial *t)
{
    return !is_good(s, t) && is_nearly_good(s, t) && t->bytes < s->bytes;
}

// Whether nothing that the step is judged by has changed since it was measured. A photograph that
// goes changes the views around it alone.
static bool is_measured(const struct trim_search *s, const struct trial *t)
{
    const struct trim_measured *m = &t->move->measured;
    bool same = t->move->tried && t->move->version >= (is_local(t) ? s->changed : s->version);
    for (size_t i = 0; same && i < m->view_count; i++) // false where the score is not known
        same = s->now[m->views[i]].db == m->before[i].db;
    return same;
}

// Whether frames have to be drawn to know what the step does to their time. Fewer points, smaller
// maps and smaller photographs make no frame slower, and files are not drawn; photographs go one by
// one, each with too little effect to be seen. What all steps together save is timed with the whole.
// Nor is what loses too much to be taken.
static bool is_timed(const struct trim_search *s, const struct trial *t)
{
    enum orl_trim_part part = t->move->part;
    if (part == ORL_TRIM_PHOTOGRAPH || part == ORL_TRIM_QUALITY)
        return false;
    bool asked = s->params->max_frame_ms > 0 || (s->params->explain && !t->move->tried);
    bool changes = part == ORL_TRIM_TEXTURES || part == ORL_TRIM_OPTION;
    return asked || (changes && is_good(s, t));
}

static enum orl_result measure(struct trim_search *s, struct trial *t)
{
    struct trim_measured *m = &t->move->measured;
    if (is_measured(s, t))
        return ORL_OK;
    enum orl_result result =
        is_local(t) ? measure_local(s, t) : measure_global(s, t, s->validation_count);
    if (result == ORL_OK && !is_local(t) && is_doubtful(s, t))
        result = measure_global(s, t, s->targets.count);
    m->slower = 1;
    m->slow = false;
    m->total_loss_db = s->total_loss_db;
    if (result == ORL_OK && is_timed(s, t))
        result = measure_time(s, t);
    t->move->version = s->version;
    return result;
}

// --- what it is worth ---

// The loss in dB, or that of SSIM where it takes a greater share of what may be lost: where
// photographs do not fit each other, PSNR rises as they become blurred. What changes beside a
// photograph ranks its removal, too.
static double weighed_loss(const struct trim_search *s, const struct trim_measured *m)
{
    const struct orl_trim_params *p = s->params;
    double ssim = p->tolerance_ssim > 0 ? m->loss_ssim * p->tolerance_db / p->tolerance_ssim : 0;
    return fmax(m->loss_db, ssim) + m->beside_db;
}

// Whether the model, or a step, waits for a frame that takes less time.
static bool waits_for_time(const struct trim_search *s)
{
    if (!orl_trim_has_budget(s) && s->slower > orl_trim_slow_limit(s))
        return true;
    for (size_t i = 0; i < s->move_count; i++)
        if (s->moves[i].slow && !s->moves[i].dead)
            return true;
    return false;
}

// Shares of what is saved, weighted. A step that slows a frame is no worse for it within the limit.
static double gain_of(const struct trim_search *s, const struct trial *t)
{
    double bytes = (s->bytes - t->bytes) / s->first_bytes;
    double files = (s->file_bytes - t->file_bytes) / s->first_file_bytes;
    double time = s->slower * fmax(1 - t->move->measured.slower, 0);
    if (s->params->max_frame_ms > 0 && !s->params->max_bytes)
        return time;
    double weight = waits_for_time(s) ? weight_of_waiting : weight_of_time;
    return bytes + weight_of_files * files + weight * time;
}

// Smaller files and passes that go would use up the tolerance: they come when nothing else makes
// the model smaller on the device. Passes go earlier when a smaller model waits for the time that
// they take. Where a frame's time is what is wanted, all moves are alike.
static bool comes_later(const struct trim_search *s, const struct trim_move *move)
{
    return !(s->params->max_frame_ms > 0) &&
           (move->part == ORL_TRIM_QUALITY ||
            (move->part == ORL_TRIM_OPTION && !waits_for_time(s)));
}

static bool promises_more(const struct trim_search *s, const struct trim_move *a,
                          const struct trim_move *b)
{
    bool later = comes_later(s, a);
    return later != comes_later(s, b) ? !later : a->ratio > b->ratio;
}

struct trim_move *orl_trim_best_move(const struct trim_search *s, const struct trim_move *except)
{
    struct trim_move *best = NULL;
    for (size_t i = 0; i < s->move_count; i++) {
        struct trim_move *m = &s->moves[i];
        bool open = !m->dead && !m->blocked &&
                    (!s->options_only || m->part == ORL_TRIM_OPTION);
        if (m != except && open && (!best || promises_more(s, m, best)))
            best = m;
    }
    return best;
}

// --- taking it ---

static enum orl_result note_step(struct trim_search *s, const struct trial *t, bool taken)
{
    struct orl_trim *trim = s->trim;
    const struct trim_measured *m = &t->move->measured;
    double ms = s->first_ms * s->slower;
    enum orl_result result = orl_grow(s->source.log, (void **)&trim->steps, &trim->step_capacity,
                                      trim->step_count + 1, sizeof *trim->steps);
    if (result != ORL_OK)
        return result;
    struct orl_trim_step *step = &trim->steps[trim->step_count++];
    *step = (struct orl_trim_step){
        .part = t->move->part, .loss_db = m->loss_db, .loss_ssim = m->loss_ssim,
        .saved_bytes = s->bytes - t->bytes,
        .saved_ms = ms * (1 - m->slower), .saved_file_bytes = s->file_bytes - t->file_bytes,
        .first = !t->move->tried, .taken = taken, .bytes = t->bytes, .ms = ms * m->slower,
        .total_loss_db = s->total_loss_db + m->loss_db,
        .total_loss_ssim = s->total_loss_ssim + m->loss_ssim};
    memcpy(step->what, t->what, sizeof step->what);
    if (s->params->on_step)
        s->params->on_step(s->params->priv, step);
    return ORL_OK;
}

static enum orl_result take(struct trim_search *s, struct trial *t)
{
    enum orl_result result = orl_grow(s->source.log, (void **)&s->history, &s->history_capacity,
                                      s->history_count + 1, sizeof *s->history);
    if (result != ORL_OK)
        return result;
    s->history[s->history_count++] = (struct trim_past){.state = s->state, .slower = s->slower,
                                                        .step = s->trim->step_count - 1,
                                                        .move = t->move};
    for (size_t i = 0; i < s->targets.count; i++) {
        struct trim_score after;
        s->lost_db[i] += view_loss(s, t, i, &after);
        s->now[i] = after;
    }
    s->total_loss_db += t->move->measured.loss_db;
    s->total_loss_ssim += t->move->measured.loss_ssim;
    s->bytes = t->bytes;
    s->file_bytes = t->file_bytes;
    s->slower *= t->move->measured.slower;
    s->state = t->state;
    t->state.removed = NULL;
    if (t->own) {
        orl_trim_model_close(&s->model);
        s->model = t->own;
        t->own = NULL;
    }
    s->version++;
    if (!is_local(t))
        s->changed = s->version;
    return ORL_OK;
}

// Whether a step that lost too much when it was measured is worth another trial. The losses of most
// views were estimated then, and may have been overrated. Other steps may have made room since, when
// a step may also lose less than before.
static bool may_fit(const struct trim_search *s, struct trim_move *move)
{
    const struct trial t = {.move = move};
    double room_db = move->measured.total_loss_db - s->total_loss_db;
    return is_good(s, &t) ||
           (room_db > min_room * s->params->tolerance_db && is_nearly_good(s, &t));
}

void orl_trim_make_room(struct trim_search *s)
{
    for (size_t i = 0; i < s->move_count; i++) {
        struct trim_move *m = &s->moves[i];
        double slower = s->slower * m->measured.slower;
        bool fits = m->slow ? slower <= orl_trim_slow_limit_on_way(s)
                            : m->blocked && may_fit(s, m);
        m->blocked &= !fits;
        m->slow &= !fits;
    }
}

enum orl_result orl_trim_try(struct trim_search *s, struct trim_move *move)
{
    struct trial t;
    if (!orl_trim_is_possible(s, move)) {
        move->dead = true;
        return ORL_OK;
    }
    enum orl_result result = begin(s, move, &t);
    if (result == ORL_OK)
        result = measure(s, &t);
    if (result != ORL_OK) {
        end(&t);
        return result;
    }
    double gain = gain_of(s, &t);
    bool slow = move->measured.slow, good = gain > 0 && is_good(s, &t);
    double loss = weighed_loss(s, &move->measured);
    orl_logf(s->source.log, ORL_LOG_DEBUG, "%s: %.3f dB, SSIM %.4f of %zu photographs, worst "
             "%.3f dB in all, gain %.3f", t.what, move->measured.loss_db, move->measured.loss_ssim,
             move->measured.view_count, worst_loss(s, &t), gain);
    move->ratio = gain / fmax(loss, min_loss_db);
    const struct trim_move *other = orl_trim_best_move(s, move);
    // What loses nothing need not be compared, except photographs, which stand in for each other.
    // Nor is there time to compare options that end what makes a frame too slow.
    bool lossless = loss <= min_loss_db && move->part != ORL_TRIM_PHOTOGRAPH;
    bool taken = good && !slow &&
                 (!other || lossless || s->options_only || comes_later(s, other) != comes_later(s, move) ||
                  good_enough * other->ratio <= move->ratio);
    if (taken || !move->tried)
        result = note_step(s, &t, taken);
    move->tried = true;
    move->dead = gain <= 0 && is_good(s, &t); // what loses too much was not timed
    move->slow = good && slow;
    move->blocked = !good || slow;
    if (result == ORL_OK && taken) {
        result = take(s, &t);
        orl_trim_make_room(s);
        // The next level may be worth half as much, or as much after one that lost nothing; all
        // others go only once.
        move->ratio = lossless ? INFINITY : 0.5 * move->ratio;
        move->dead = move->part == ORL_TRIM_PHOTOGRAPH || move->part == ORL_TRIM_OPTION ||
                     move->part == ORL_TRIM_TEXTURES;
    }
    end(&t);
    return result;
}

enum orl_result orl_trim_take_measured(struct trim_search *s, struct trim_move *move)
{
    struct trial t;
    enum orl_result result = begin(s, move, &t);
    if (result == ORL_OK)
        result = note_step(s, &t, true);
    if (result == ORL_OK)
        result = take(s, &t);
    move->tried = move->dead = true;
    end(&t);
    return result;
}

enum orl_result orl_trim_take_options(struct trim_search *s,
                                      const struct orl_render_params *render)
{
    struct trim_move move = {.part = ORL_TRIM_OPTION, .tried = true};
    struct trial t = {.move = &move, .bytes = s->bytes, .file_bytes = s->file_bytes};
    struct trim_measured *m = &move.measured;
    snprintf(t.what, sizeof t.what, "tuned options");
    enum orl_result result =
        orl_trim_state_copy(s->source.log, &s->state, s->source.scene->photo_count, &t.state);
    t.state.render = *render;
    if (result == ORL_OK)
        result = measure_global(s, &t, s->targets.count < TUNED_JUDGES ? s->targets.count
                                                                       : TUNED_JUDGES);
    bool better = m->loss_db < 0 && is_good(s, &t);
    m->slower = 1;
    if (result == ORL_OK && better)
        result = measure_time(s, &t);
    bool taken = better && !m->slow;
    if (result == ORL_OK)
        result = note_step(s, &t, taken);
    if (result == ORL_OK && taken)
        result = take(s, &t);
    if (result == ORL_OK && taken)
        s->history[s->history_count - 1].move = NULL; // it ends with this function
    end(&t);
    return result;
}
