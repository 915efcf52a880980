// The search: a ladder. Its rungs are parts of the model, in the order of what they save for what they
// lose on the scenes that were measured. Each is taken as far as the tolerances allow: parts with few
// levels one after the other, points and photographs by bisection.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/process.h"
#include "eval/trim_search.h"

const char *const orl_trim_part_names[ORL_TRIM_PART_COUNT] = {
    "points", "photograph", "textures", "depth", "option"};

enum {
    MENDS_MAX = 4,       // of photographs that go together
    BISECTIONS = 5,      // of points or photographs
    BUDGET_DIVIDE = 12,  // towards a budget they go in so many steps
};
// The last part of the time is for a frame that has become too slow.
static const double time_for_ladder = 0.8;
// Towards a budget the tolerances grow from the first of these by the second, up to the third.
static const double budget_first_db = 0.025, budget_growth = 2, budget_last_db = 100;
// SSIM of the same size, as the default tolerances have it.
static const double ssim_per_db = 0.1;

// Options whose cheaper values save time.
static const char *const cheaper[] = {
    "sampling=bilinear", "antialias=off", "median=off", "guess_blur=0",
    "outliers=0", "min_support=0", "photos_per_pixel=2"};

// `max`: the last level; of options: none. `share`: of what is left of the tolerances.
struct rung {
    enum orl_trim_part part;
    size_t max;
    double share;
};
static const struct rung ladder[] = {
    {ORL_TRIM_DEPTH, 1, 1}, // half floats, which lose nothing
    {ORL_TRIM_TEXTURES, ORL_TEXTURES_YCC, 1},
    {ORL_TRIM_DEPTH, TRIM_DEPTH_LEVELS - 1, 1},
    {ORL_TRIM_TEXTURES, ORL_TEXTURES_BC1, 1},
    {ORL_TRIM_PHOTOGRAPH, SIZE_MAX, 0.5},
    {ORL_TRIM_POINTS, TRIM_POINT_LEVELS - 1, 1},
    {ORL_TRIM_OPTION, 0, 1},
};

// --- options ---

// Sets `next` to the options with this assignment. False when it changes nothing or the method does
// not read it.
static bool assign(const struct orl_render_params *render, const struct orl_render_option *option,
                   const char *assignment, struct orl_render_params *next)
{
    *next = *render;
    if (!option || orl_render_params_set(NULL, next, assignment) != ORL_OK)
        return false;
    if (option->kind == ORL_OPTION_NUMBER)
        return orl_render_option_number(option, next) < orl_render_option_number(option, render);
    return memcmp(next, render, sizeof *next) != 0;
}

// --- levels ---

size_t orl_trim_validation_view(const struct trim_search *s, size_t i, size_t count)
{
    return (2 * i + 1) * s->targets.count / (2 * count);
}

// The last level that the scene allows.
static size_t max_level(const struct trim_search *s, const struct rung *rung)
{
    if (rung->part == ORL_TRIM_PHOTOGRAPH)
        return s->targets.count - ORL_VALIDATION_TRAIN_MIN;
    return rung->part == ORL_TRIM_POINTS && !s->source.scene->points.count ? 0 : rung->max;
}

static bool has_level(const struct trim_search *s, const struct rung *rung, size_t level)
{
    return rung->part != ORL_TRIM_TEXTURES ||
           (level >= ORL_TEXTURES_YCC &&
            orl_textures_available(s->source.gpu, (enum orl_textures)level));
}

static void remove_photographs(const struct trim_search *s, size_t count, struct trim_state *state)
{
    memset(state->removed, 0, s->source.scene->photo_count * sizeof *state->removed);
    state->removed_count = count;
    for (size_t k = 0; k < count; k++)
        state->removed[s->targets.views[s->order[k]].photo] = true;
}

static void set_level(const struct trim_search *s, enum orl_trim_part part, size_t level,
                      struct trim_trial *t)
{
    struct trim_state *state = &t->now.state;
    struct orl_scene_defaults defaults;
    enum { SIZE = sizeof t->what };
    state->level[part] = level;
    switch (part) {
    case ORL_TRIM_POINTS:
        snprintf(t->what, SIZE, "points %.3g %%", 100 * orl_trim_point_shares[level]);
        break;
    case ORL_TRIM_PHOTOGRAPH:
        remove_photographs(s, level, state);
        break;
    case ORL_TRIM_TEXTURES:
        snprintf(t->what, SIZE, "textures %s", orl_textures_names[level]);
        break;
    default:
        defaults = orl_trim_defaults(&s->source, state);
        snprintf(t->what, SIZE, "depth 1/%d, %d bits", defaults.depth_divide,
                 defaults.depth_half ? 16 : 32);
    }
}

// --- budgets ---

bool orl_trim_has_budget(const struct trim_search *s)
{
    return s->params->max_bytes || s->params->max_frame_ms > 0;
}

static bool has_bytes(const struct trim_search *s)
{
    return !s->params->max_bytes || s->now.bytes <= (double)s->params->max_bytes;
}

static bool has_time(const struct trim_search *s)
{
    return !(s->params->max_frame_ms > 0) || s->first_ms * s->now.slower <= s->params->max_frame_ms;
}

static bool within_budget(const struct trim_search *s)
{
    return orl_trim_has_budget(s) && has_bytes(s) && has_time(s);
}

static bool is_spent(const struct trim_search *s, double share)
{
    return s->params->budget_s > 0 && orl_time_s() - s->start_s >= share * s->params->budget_s;
}

// Whether the step saves what is wanted: bytes, or time by options; towards a budget, what is above it.
static bool is_wanted(const struct trim_search *s, const struct trim_trial *t)
{
    if (orl_trim_has_budget(s))
        return (!has_bytes(s) && t->now.bytes < s->now.bytes) || (!has_time(s) && t->now.slower < 1);
    return t->part == ORL_TRIM_OPTION ? t->now.slower < 1 : t->now.bytes < s->now.bytes;
}

// --- steps ---

// Measures the trial and takes it if it fits and is wanted. What loses too much to be taken is not timed,
// and fewer points and smaller maps make no frame slower.
static enum orl_result decide(struct trim_search *s, struct trim_trial *t, bool shares,
                              double share, bool *taken)
{
    *taken = false;
    ORL_TRY(orl_trim_trial_measure(s, t, shares));
    bool fits = orl_trim_trial_fits(s, t, share);
    bool slows = t->part == ORL_TRIM_TEXTURES || t->part == ORL_TRIM_OPTION;
    if (fits && (slows || s->params->max_frame_ms > 0))
        ORL_TRY(orl_trim_time_trial(s, t));
    *taken = fits && is_wanted(s, t);
    orl_logf(s->source.log, ORL_LOG_DEBUG, "%s: loses %.3f dB, SSIM %.4f; in all %.3f dB, the worst "
             "%.3f dB%s", t->what, t->step.db, t->step.ssim, t->now.loss.db, t->now.loss.worst_db,
             *taken ? ": taken" : "");
    return *taken ? orl_trim_trial_take(s, t) : ORL_OK;
}

// Photographs come back that views beside them, or views that lose too much, need.
static enum orl_result mend(struct trim_search *s, struct trim_trial *t)
{
    enum orl_result result = orl_trim_put_back(s, &t->now.state);
    for (int i = 0; result == ORL_OK && i < MENDS_MAX; i++) {
        result = orl_trim_trial_measure(s, t, true);
        if (result == ORL_OK && !orl_trim_mend(s, t))
            break;
    }
    snprintf(t->what, sizeof t->what, "photographs %zu of %zu",
             s->targets.count - t->now.state.removed_count, s->targets.count);
    return result;
}

static enum orl_result try_level(struct trim_search *s, const struct rung *rung, size_t level,
                                 bool *taken)
{
    struct trim_trial t;
    bool photographs = rung->part == ORL_TRIM_PHOTOGRAPH;
    enum orl_result result = orl_trim_trial_begin(s, rung->part, &t);
    *taken = false;
    if (result == ORL_OK)
        set_level(s, rung->part, level, &t);
    if (result == ORL_OK && photographs)
        result = mend(s, &t);
    ORL_THEN(result, decide(s, &t, photographs, rung->share, taken));
    orl_trim_trial_end(&t);
    return result;
}

// Not possible: it is not taken.
static enum orl_result try_option(struct trim_search *s, const char *assignment)
{
    struct trim_trial t;
    struct orl_render_params next;
    bool taken;
    char key[64];
    snprintf(key, sizeof key, "%.*s", (int)strcspn(assignment, "="), assignment);
    const struct orl_render_option *option = orl_render_option_find(key);
    if (!assign(&s->now.state.render, option, assignment, &next))
        return ORL_OK;
    enum orl_result result = orl_trim_trial_begin(s, ORL_TRIM_OPTION, &t);
    t.now.state.render = next;
    snprintf(t.what, sizeof t.what, "%s", assignment);
    // Where the splats change, the photographs' depth maps are drawn anew.
    ORL_THEN(result, decide(s, &t, !strstr(option->readers, "proxy="), 1, &taken));
    orl_trim_trial_end(&t);
    return result;
}

// Whether the search ends here; the time that ran out is noted.
static bool ends(struct trim_search *s)
{
    if (is_spent(s, time_for_ladder))
        s->trim->complete = false;
    return !s->trim->complete || within_budget(s);
}

// --- rungs ---

static enum orl_result bisect(struct trim_search *s, const struct rung *rung)
{
    size_t low = s->now.state.level[rung->part], high = max_level(s, rung);
    for (int i = 0; low < high && i < BISECTIONS && !ends(s); i++) {
        size_t level = (low + high + 1) / 2;
        bool taken;
        ORL_TRY(try_level(s, rung, level, &taken));
        if (taken)
            low = level;
        else
            high = level - 1;
    }
    return ORL_OK;
}

static enum orl_result climb_levels(struct trim_search *s, const struct rung *rung, size_t by)
{
    bool taken = true;
    for (size_t level = s->now.state.level[rung->part] + by;
         taken && level <= max_level(s, rung) && !ends(s); level += by)
        if (has_level(s, rung, level))
            ORL_TRY(try_level(s, rung, level, &taken));
    return ORL_OK;
}

// Ends early when a frame is as fast as it should be, if that is what is wanted.
static enum orl_result climb_options(struct trim_search *s, bool until_fast)
{
    for (size_t i = 0; i < ORL_COUNT(cheaper); i++) {
        if (until_fast ? s->now.slower <= orl_trim_slow_limit(s) || is_spent(s, 1) : ends(s))
            break;
        ORL_TRY(try_option(s, cheaper[i]));
    }
    return ORL_OK;
}

static enum orl_result climb_rung(struct trim_search *s, const struct rung *rung)
{
    bool many = rung->part == ORL_TRIM_POINTS || rung->part == ORL_TRIM_PHOTOGRAPH;
    if (rung->part == ORL_TRIM_OPTION)
        return climb_options(s, false);
    if (many && !orl_trim_has_budget(s))
        return bisect(s, rung);
    ORL_TRY(climb_levels(s, rung, many ? max_level(s, rung) / BUDGET_DIVIDE + 1 : 1));
    bool textures = rung->part == ORL_TRIM_TEXTURES && !orl_trim_has_budget(s);
    return textures ? climb_options(s, true) : ORL_OK;
}

static enum orl_result climb_ladder(struct trim_search *s)
{
    for (size_t i = 0; i < ORL_COUNT(ladder) && !ends(s); i++) {
        orl_progress_report(s->params->progress, "trim", (double)i, (double)ORL_COUNT(ladder),
                            orl_trim_part_names[ladder[i].part]);
        ORL_TRY(climb_rung(s, &ladder[i]));
    }
    return ORL_OK;
}

enum orl_result orl_trim_climb(struct trim_search *s)
{
    s->trim->complete = true;
    if (!orl_trim_has_budget(s))
        return climb_ladder(s);
    for (double db = budget_first_db; !ends(s) && db < budget_last_db; db *= budget_growth) {
        s->most.db = db;
        s->most.ssim = ssim_per_db * db;
        ORL_TRY(climb_ladder(s));
    }
    s->most.db = s->most.ssim = INFINITY; // nothing is taken back
    if (s->trim->complete && !within_budget(s))
        return orl_fail(s->source.log, ORL_ERR_DATA,
                        "%s: the least model takes %.2f MiB and %.1f ms a frame, which is more "
                        "than is allowed", s->source.scene->dir, s->now.bytes / (1 << 20),
                        s->first_ms * s->now.slower);
    return ORL_OK;
}

// --- the time of a frame ---

// Compressed textures are what makes a frame slower.
static enum orl_result drop_textures(struct trim_search *s)
{
    struct trim_trial t;
    enum orl_result result = orl_trim_trial_begin(s, ORL_TRIM_TEXTURES, &t);
    t.now.state.level[ORL_TRIM_TEXTURES] = ORL_TEXTURES_AUTO;
    snprintf(t.what, sizeof t.what, "textures as they were");
    ORL_THEN(result, orl_trim_trial_measure(s, &t, false));
    ORL_THEN(result, orl_trim_trial_take(s, &t));
    orl_trim_trial_end(&t);
    return result;
}

enum orl_result orl_trim_make_faster(struct trim_search *s)
{
    bool slow;
    ORL_TRY(orl_trim_time_whole(s, &slow));
    if (slow) {
        ORL_TRY(climb_options(s, true));
        ORL_TRY(orl_trim_time_whole(s, &slow));
    }
    if (slow && s->now.state.level[ORL_TRIM_TEXTURES] != ORL_TEXTURES_AUTO) {
        ORL_TRY(drop_textures(s));
        ORL_TRY(orl_trim_time_whole(s, &slow));
    }
    return ORL_OK;
}

// --- tuned options ---

enum orl_result orl_trim_take_options(struct trim_search *s,
                                      const struct orl_render_params *render)
{
    struct trim_trial t;
    enum orl_result result = orl_trim_trial_begin(s, ORL_TRIM_OPTION, &t);
    t.now.state.render = *render;
    snprintf(t.what, sizeof t.what, "tuned options");
    ORL_THEN(result, orl_trim_trial_measure(s, &t, false));
    bool better = result == ORL_OK && t.step.db < 0 && orl_trim_trial_fits(s, &t, 1);
    if (better)
        result = orl_trim_time_trial(s, &t);
    if (better && result == ORL_OK && t.now.slower <= orl_trim_slow_limit(s))
        result = orl_trim_trial_take(s, &t);
    orl_trim_trial_end(&t);
    return result;
}
