// The search: a ladder. Its rungs are parts of the model, in the order of what they save for what they
// lose on the scenes that were measured. Each is taken as far as the tolerances allow: parts with few
// levels one after the other, points and photographs by bisection.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/process.h"
#include "eval/trim_search.h"

const char *const orl_trim_part_names[ORL_TRIM_PART_COUNT] = {
    "points", "photograph", "textures", "depth", "option"};

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
    {ORL_TRIM_DEPTH, TRIM_DEPTH_LEVELS - 1, 1},
    {ORL_TRIM_TEXTURES, ORL_TEXTURES_BC1, 1},
    {ORL_TRIM_PHOTOGRAPH, SIZE_MAX, 0.5},
    {ORL_TRIM_POINTS, TRIM_POINT_LEVELS - 1, 1},
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
        snprintf(t->step.what, SIZE, "points %.3g %%", 100 * orl_trim_point_shares[level]);
        return true;
    case ORL_TRIM_TEXTURES:
        snprintf(t->step.what, SIZE, "textures %s",
                 level == ORL_TEXTURES_AUTO ? "as they were" : orl_textures_names[level]);
        return level == ORL_TEXTURES_AUTO ||
               (level >= ORL_TEXTURES_YCC && orl_textures_available(s->gpu, (enum orl_textures)level));
    case ORL_TRIM_DEPTH:
        defaults = orl_trim_defaults(s, t);
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

bool orl_trim_has_budget(const struct trim_search *s)
{
    return s->params->max_mib > 0 || s->params->max_frame_ms > 0;
}

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
    return orl_trim_has_budget(s) && has_bytes(s) && has_time(s);
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
    return orl_trim_fits(s, &t->loss, share) && (!special || orl_score_better(&t->score, &s->now->score, 0));
}

// Whether the step saves what is wanted: bytes, or time by options; towards a budget, what is above it.
static bool is_wanted(const struct trim_search *s, const struct trim_state *t)
{
    bool smaller = t->step.bytes < s->now->step.bytes, faster = t->slower < s->now->slower;
    bool option = t->step.part == ORL_TRIM_OPTION;
    if (t->level[t->step.part] == 0)
        return !option || t->slower <= orl_trim_slow_limit(s);
    if (orl_trim_has_budget(s))
        return (!has_bytes(s) && smaller) || (!has_time(s) && faster);
    return option ? faster : smaller;
}

// --- steps ---

// Takes the measured state if it is allowed and wanted. What loses too much to be taken is not timed, and
// fewer points and smaller maps make no frame slower.
static enum orl_result decide(struct trim_search *s, struct trim_state **trial, double share, bool *taken)
{
    struct trim_state *t = *trial;
    bool allowed = is_allowed(s, t, share);
    bool slows = t->step.part == ORL_TRIM_TEXTURES || t->step.part == ORL_TRIM_OPTION;
    if (allowed && (slows || s->params->max_frame_ms > 0))
        ORL_TRY(orl_trim_time_trial(s, t));
    *taken = allowed && is_wanted(s, t);
    orl_logf(s->log, ORL_LOG_DEBUG, "%s: loses %.3f dB, SSIM %.4f; in all %.3f dB, the worst %.3f dB%s",
             t->step.what, t->step.loss_db, t->step.loss_ssim, t->loss.psnr_db, t->loss.worst_db,
             *taken ? ": taken" : "");
    return *taken ? orl_trim_take(s, trial) : ORL_OK;
}

// Whether a higher level may be taken, too: this one was, or is none that the scene has.
static enum orl_result try_level(struct trim_search *s, const struct rung *rung, size_t level, bool *higher)
{
    struct trim_state *t;
    enum orl_result result = orl_trim_state_begin(s, rung->part, &t);
    *higher = true;
    if (result == ORL_OK && set_level(s, level, t)) {
        result = rung->part == ORL_TRIM_PHOTOGRAPH ? orl_trim_remove_photos(s, level, t) : orl_trim_measure(s, t);
        ORL_THEN(result, decide(s, &t, rung->share, higher));
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
    bool halves = many && !orl_trim_has_budget(s);
    size_t low = option ? 0 : s->now->level[rung->part], high = max_level(s, rung);
    size_t by = many ? high / BUDGET_DIVIDE + 1 : 1;
    for (int i = 0; low < high && (!halves || i < BISECTIONS); i++) {
        size_t level = halves ? (low + high + 1) / 2 : low + by;
        bool higher;
        if (level > high || (until_fast ? s->now->slower <= orl_trim_slow_limit(s) || is_spent(s, 1) : ends(s)))
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
        if (ladder[i].part == ORL_TRIM_TEXTURES && !orl_trim_has_budget(s))
            ORL_TRY(climb_rung(s, options, true));
    }
    return ORL_OK;
}

enum orl_result orl_trim_climb(struct trim_search *s)
{
    s->trim->complete = true;
    if (!orl_trim_has_budget(s))
        return climb_ladder(s);
    for (double db = budget_first_db; !ends(s) && db < budget_last_db; db *= budget_growth) {
        s->most.psnr_db = db;
        s->most.ssim = ssim_per_db * db;
        ORL_TRY(climb_ladder(s));
    }
    s->most.psnr_db = s->most.ssim = INFINITY; // nothing is taken back
    if (s->trim->complete && !within_budget(s))
        return orl_fail(s->log, ORL_ERR_DATA,
                        "%s: the least model takes %.2f MiB and %.1f ms a frame, which is more "
                        "than is allowed", s->scene->dir, s->now->step.bytes / (1 << 20),
                        s->first_ms * s->now->slower);
    return ORL_OK;
}

enum orl_result orl_trim_make_faster(struct trim_search *s)
{
    bool slow, taken;
    ORL_TRY(orl_trim_time_whole(s, &slow));
    if (slow) {
        ORL_TRY(climb_rung(s, options, true));
        ORL_TRY(orl_trim_time_whole(s, &slow));
    }
    if (slow && s->now->level[ORL_TRIM_TEXTURES] != ORL_TEXTURES_AUTO) {
        ORL_TRY(try_level(s, textures, ORL_TEXTURES_AUTO, &taken));
        ORL_TRY(orl_trim_time_whole(s, &slow));
    }
    return ORL_OK;
}

enum orl_result orl_trim_take_tuned(struct trim_search *s)
{
    bool taken;
    return try_level(s, options, 0, &taken);
}
