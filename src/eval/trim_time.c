// How long frames take: with a step on trial beside the model so far, and of the trimmed scene
// beside the whole one. Only ratios of frames drawn in turns decide, since other programs on the
// machine change all times.
#include <math.h>

#include "core/process.h"
#include "eval/timing.h"
#include "eval/trim_search.h"

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
    struct trim_search *s;
    const struct trim_state *states[2];
    size_t frames;
};

static enum orl_result time_frame(struct trim_search *s, const struct trim_state *state, size_t round, double *ms)
{
    bool software = orl_gpu_caps(s->gpu)->software;
    struct orl_render_params render = state->render;
    size_t target = orl_trim_validation_view(s, round % s->validation_count, s->validation_count);
    if (orl_progress_cancelled(s->params->progress))
        return ORL_ERR_CANCELLED;
    render.leave_out |= ORL_LAYER_NORMAL;
    double start = software ? orl_cpu_time_s() : orl_time_s();
    enum orl_result result = orl_renderer_draw(orl_trim_model_of(state)->renderer, &s->targets.views[target].view,
                                               &render, state->removed, NULL);
    double end = software ? orl_cpu_time_s() : orl_time_s();
    *ms = 1e3 * (end - start);
    return result;
}

static enum orl_result time_one(void *priv, bool second, double *ms)
{
    struct pair *pair = priv;
    return time_frame(pair->s, pair->states[second], pair->frames++ / 2, ms);
}

static enum orl_result compare(struct trim_search *s, const struct trim_state *first, const struct trim_state *second,
                               double limit, double error, size_t rounds_max, struct orl_pair_timing *timing)
{
    struct pair pair = {s, {first, second}, 0};
    const struct orl_pair_timing_params params = {.time = time_one, .priv = &pair, .limit = limit,
                                                  .error = error, .rounds_max = rounds_max};
    double unused;
    // The first frame of each view reads the photographs that the view is painted from.
    for (size_t k = 0; k < 2 * s->validation_count; k++)
        ORL_TRY(time_frame(s, pair.states[k % 2], k / 2, &unused));
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
    bool closed = !s->first->model;
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
