// The search: steps that make the model smaller are tried and, best first, taken. What a step costs
// and saves is measured again only when it is the most promising one and others have been taken
// since (lazy greedy, Minoux 1978): the time grows with the number of steps, not with its square.
#include "eval/trim.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/new_dir.h"
#include "core/process.h"
#include "eval/trim_search.h"
#include "eval/tune.h"

const char *const orl_trim_part_names[ORL_TRIM_PART_COUNT] = {
    "points", "photograph", "textures", "depth", "resolution", "quality", "option"};

enum { RANKED_VIEWS = 48, TUNED_VIEWS = 6, TUNED_DIVIDE = 2 };
// Least gain of a tuned option, as a share of the tolerance.
static const double tuned_gain = 0.1;
// Share of the time that tuning may take.
static const double tuned_time = 0.2;
// After this share of the time, a model whose frame takes too long is only made faster: otherwise
// what made it slower would have to be taken back.
static const double time_for_all = 0.8;

// --- the search ---

// Whether this share of the time that the search may take is gone.
static bool is_spent(const struct trim_search *s, double share)
{
    return s->params->budget_s > 0 &&
           orl_time_s() - s->start_s >= share * s->params->budget_s;
}

static bool within_budget(const struct trim_search *s)
{
    const struct orl_trim_params *p = s->params;
    return orl_trim_has_budget(s) && (!p->max_bytes || s->bytes <= (double)p->max_bytes) &&
           (!(p->max_frame_ms > 0) || s->first_ms * s->slower <= p->max_frame_ms);
}

// All training photographs confirm other steps before photographs are removed. What removals lose is
// added to measured losses then, and other steps are not blamed for them.
static bool is_due(const struct trim_search *s, const struct trim_move *next)
{
    return !orl_trim_has_budget(s) && next->part == ORL_TRIM_PHOTOGRAPH &&
           s->state.removed_count == 0 && s->history_count > s->confirmed;
}

static enum orl_result search(struct trim_search *s)
{
    enum orl_result result = ORL_OK;
    double done = 0;
    s->trim->complete = true;
    while (result == ORL_OK && !within_budget(s)) {
        s->options_only = !orl_trim_has_budget(s) && is_spent(s, time_for_all) &&
                          s->slower > orl_trim_slow_limit(s);
        struct trim_move *move = orl_trim_best_move(s, NULL);
        if (!move && !s->options_only)
            break;
        if (!move || is_spent(s, 1)) {
            s->trim->complete = false;
            break;
        }
        if (is_due(s, move)) {
            result = orl_trim_confirm(s, TRIM_CONFIRM_LOSSES);
            continue;
        }
        // Most moves are tried once, some a few times.
        double total = fmax(2.0 * (double)s->move_count, done + 1);
        orl_progress_report(s->params->progress, "trim", done++, total,
                            orl_trim_part_names[move->part]);
        bool group = move->part == ORL_TRIM_PHOTOGRAPH && orl_trim_has_group(s);
        result = group ? orl_trim_try_group(s) : orl_trim_try(s, move);
    }
    if (result == ORL_OK && orl_trim_has_budget(s) && !within_budget(s) && s->trim->complete)
        result = orl_fail(s->source.log, ORL_ERR_DATA,
                          "%s: the least model takes %.2f MiB and %.1f ms a frame, which is more "
                          "than is allowed", s->source.scene->dir, s->bytes / (1 << 20),
                          s->first_ms * s->slower);
    return result;
}

// The validation photographs are few, so that steps may cost less than they said: the search goes
// on with what is left of the tolerance, as long as it finds more to leave out. It also goes on without steps that
// were taken back. Those that make a frame too slow are taken back only when the search finds
// nothing any more that makes it faster.
static enum orl_result search_and_confirm(struct trim_search *s)
{
    enum orl_result result = ORL_OK;
    for (size_t ended = SIZE_MAX; result == ORL_OK;) {
        result = search(s);
        bool found = s->version != ended;
        bool last = orl_trim_has_budget(s) || !s->trim->complete;
        if (result != ORL_OK || !(found || s->slow))
            break;
        result = orl_trim_confirm(s, found && !last ? TRIM_CONFIRM_TIMED : TRIM_CONFIRM_LAST);
        if (last)
            break;
        ended = s->version;
    }
    return result;
}

// --- the held-out photographs ---

static enum orl_result compare_held(struct trim_search *s, struct orl_renderer *renderer,
                                    const struct orl_render_params *render,
                                    struct orl_trim_figures *figures)
{
    const struct orl_scene *scene = s->source.scene;
    size_t held = 0;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; i < scene->photo_count; i++)
        held += scene->photos[i].test;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        struct orl_heldout view = {0};
        struct orl_metrics m;
        if (!scene->photos[i].test)
            continue;
        result = orl_heldout_load(s->source.log, scene, i, s->params->size_divide, &view);
        if (result == ORL_OK)
            result = orl_heldout_compare(s->source.log, renderer, scene, &view, render, NULL, false,
                                         &m);
        if (result == ORL_OK) {
            figures->held_psnr_db += m.psnr_db / (double)held;
            figures->held_ssim += m.ssim / (double)held;
        }
        orl_heldout_finish(&view);
    }
    return result;
}

// Opens a scene as every command does. Held-out photographs are compared with it, and what it takes
// on the device is counted.
static enum orl_result look_at(struct trim_search *s, const char *dir,
                               const struct orl_render_params *render,
                               struct orl_trim_figures *figures)
{
    struct orl_scene *scene = NULL;
    struct orl_renderer *renderer = NULL;
    enum orl_result result = orl_scene_open(s->source.log, dir, &scene);
    if (result == ORL_OK)
        result = orl_renderer_create(s->source.gpu, scene, NULL, &renderer);
    if (result == ORL_OK)
        result = compare_held(s, renderer, render, figures);
    if (result == ORL_OK && s->targets.count)
        result = orl_renderer_draw(renderer, &s->targets.views[0].view, render, NULL, NULL);
    if (result == ORL_OK) {
        orl_trim_count_bytes(s->source.gpu, &figures->point_bytes, &figures->photo_bytes);
        for (int i = 0; i < ORL_OWNER_COUNT; i++)
            figures->device_bytes += orl_gpu_owner_bytes(s->source.gpu, (enum orl_owner)i);
        figures->file_bytes = orl_trim_scene_file_bytes(s->source.log, scene);
    }
    orl_renderer_destroy(&renderer);
    orl_scene_destroy(&scene);
    return result;
}

// --- the whole ---

static enum orl_result start(struct trim_search *s)
{
    struct trim_source *source = &s->source;
    const struct orl_trim_params *p = s->params;
    size_t photos = source->scene->photo_count;
    enum orl_result result =
        orl_validation_load(source->log, source->scene, 0, p->size_divide, &s->targets);
    size_t n = s->targets.count;
    s->first_db = orl_array(source->log, n, sizeof *s->first_db);
    s->now = orl_array(source->log, n, sizeof *s->now);
    s->lost_db = orl_array(source->log, n, sizeof *s->lost_db);
    s->first_state.render = p->start->params;
    s->first_state.removed = orl_array(source->log, photos, sizeof *s->first_state.removed);
    if (result == ORL_OK &&
        !(s->first_db && s->now && s->lost_db && s->first_state.removed))
        result = ORL_ERR_MEMORY;
    if (result == ORL_OK && !p->settings_only)
        result = orl_point_ranking_make(source->gpu, source->scene, RANKED_VIEWS, p->progress,
                                        &source->ranking);
    if (result == ORL_OK)
        result = orl_trim_state_copy(source->log, &s->first_state, photos, &s->state);
    if (result == ORL_OK)
        result = orl_trim_plan(s);
    if (result == ORL_OK)
        result = orl_trim_model_open(source, &s->state, &s->model);
    if (result == ORL_OK)
        result = orl_trim_measure_all(s, true, &s->trim->before);
    if (result == ORL_OK)
        result = orl_trim_time_first(s);
    if (result != ORL_OK)
        return result;
    s->bytes = s->first_bytes = orl_trim_model_bytes(s, s->model, &s->state);
    s->slower = 1;
    s->trim->before.frame_ms = s->first_ms;
    s->file_bytes = (double)orl_trim_photo_file_bytes(source, source->scene->dir, NULL);
    s->first_file_bytes = s->file_bytes = fmax(s->file_bytes, 1);
    return ORL_OK;
}

// Fits the method's options at half the size, where a frame takes a quarter of the time.
static enum orl_result tune(struct trim_search *s)
{
    struct orl_tune tune;
    const struct orl_trim_params *p = s->params;
    const struct orl_tune_params params = {
        .method = p->start->method->name, .start = &s->state.render,
        .size_divide = TUNED_DIVIDE * p->size_divide, .views = TUNED_VIEWS,
        .gain_db = tuned_gain * p->tolerance_db, .budget_s = tuned_time * p->budget_s,
        .progress = p->progress};
    enum orl_result result =
        orl_tune_run(s->source.gpu, s->model->renderer, s->source.scene, &params, &tune);
    if (result == ORL_OK)
        result = orl_trim_take_options(s, &tune.best);
    orl_tune_finish(&tune);
    return result;
}

static enum orl_result write_and_look(struct trim_search *s)
{
    struct orl_trim *trim = s->trim;
    enum orl_result result = ORL_OK;
    orl_trim_model_close(&s->model); // so that only the scene's own bytes are counted
    // Only now, when nothing can change any more, are held-out photographs looked at.
    if (!s->params->settings_only) {
        result = look_at(s, s->source.scene->dir, &s->first_state.render, &trim->before);
        if (result == ORL_OK)
            result = orl_trim_write_scene(&s->source, &s->state, &trim->choice, s->part);
        if (result == ORL_OK)
            result = look_at(s, s->part, &s->state.render, &trim->after);
    }
    return result;
}

static enum orl_result run(struct trim_search *s)
{
    enum orl_result result = start(s);
    if (result == ORL_OK && s->params->tune)
        result = tune(s);
    if (result == ORL_OK)
        result = search_and_confirm(s);
    if (result == ORL_OK && s->params->random)
        result = orl_trim_compare_random(s);
    if (result != ORL_OK)
        return result;
    s->trim->choice = *s->params->start;
    s->trim->choice.params = s->state.render;
    s->trim->defaults = orl_trim_defaults(&s->source, &s->state);
    result = write_and_look(s);
    if (result == ORL_OK)
        orl_progress_report(s->params->progress, "trim", 1, 1, NULL);
    return result;
}

static void finish(struct trim_search *s)
{
    orl_trim_model_close(&s->model);
    orl_point_ranking_finish(&s->source.ranking);
    orl_validation_finish(&s->targets);
    for (size_t i = 0; i < s->history_count; i++)
        free(s->history[i].state.removed);
    free(s->history);
    free(s->moves);
    free(s->nearest);
    free(s->first_db);
    free(s->now);
    free(s->lost_db);
    free(s->first_state.removed);
    free(s->state.removed);
}

enum orl_result orl_trim_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                             const struct orl_trim_params *params, struct orl_trim *trim)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    memset(trim, 0, sizeof *trim);
    ORL_REQUIRE(log, params->size_divide >= 1 && params->size_divide <= 16);
    ORL_REQUIRE(log, params->settings_only || (params->out && *params->out));
    if (scene->lod && !params->settings_only)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%s: trim needs all points in memory, and they "
                        "are in points.lod: remove it, and where there is no points.ply, oriel "
                        "prepare --resume with a larger --max-ram writes one", scene->dir);
    struct orl_new_dir part = {.fd = -1};
    char *work = NULL;
    enum orl_result result = ORL_OK;
    if (!params->settings_only)
        result = orl_new_dir_begin(log, params->out, &part);
    if (part.path)
        work = orl_path_join(log, part.path, ".trials");
    struct trim_search s = {.source = {.gpu = gpu, .log = log, .scene = scene, .work = work},
                            .params = params, .trim = trim, .part = part.path,
                            .start_s = orl_time_s()};
    if (result == ORL_OK)
        result = run(&s);
    finish(&s);
    if (result == ORL_OK && work)
        result = orl_dir_remove(log, work);
    if (result == ORL_OK && part.path)
        result = orl_new_dir_finish(log, &part);
    orl_new_dir_abort(log, &part);
    free(work);
    if (result != ORL_OK)
        orl_trim_finish(trim);
    return result;
}

void orl_trim_finish(struct orl_trim *trim)
{
    free(trim->steps);
    memset(trim, 0, sizeof *trim);
}
