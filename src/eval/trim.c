// oriel trim: the whole scene is measured, the search makes it smaller, and the result is written.
#include "eval/trim.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/new_dir.h"
#include "core/process.h"
#include "eval/trim_search.h"
#include "eval/search.h"

enum { RANKED_VIEWS = 48, TUNED_VIEWS = 6, TUNED_DIVIDE = 2 };
enum { DECIDING_MAX = 48 }; // targets that decide on a step; all confirm the whole
// Least gain of a tuned option, as a share of the tolerance.
static const double tuned_gain = 0.1;
// Share of the time that tuning may take.
static const double tuned_time = 0.2;
// --- the held-out photographs ---

static enum orl_result compare_held(struct trim_search *s, struct orl_renderer *renderer,
                                    const struct orl_render_params *render,
                                    struct orl_trim_figures *figures)
{
    const struct orl_scene *scene = s->source.scene;
    size_t held = orl_heldout_count(scene);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        struct orl_heldout view = {0};
        double psnr_db = 0, ssim = 0;
        if (!scene->photos[i].test)
            continue;
        result = orl_heldout_load(s->source.log, scene, i, s->params->size_divide, &view);
        ORL_THEN(result, orl_heldout_compare(s->source.log, renderer, scene, &view, render, NULL, &psnr_db,
                                             &ssim));
        figures->held_psnr_db += psnr_db / (double)held;
        figures->held_ssim += ssim / (double)held;
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
    ORL_THEN(result, orl_renderer_create(s->source.gpu, scene, NULL, &renderer));
    ORL_THEN(result, compare_held(s, renderer, render, figures));
    ORL_THEN(result, orl_renderer_draw(renderer, &s->targets.views[0].view, render, NULL, NULL));
    if (result == ORL_OK) {
        orl_trim_count_bytes(s->source.gpu, &figures->point_bytes, &figures->photo_bytes);
        figures->device_bytes = orl_gpu_bytes(s->source.gpu);
        figures->file_bytes = orl_trim_scene_file_bytes(scene);
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
    ORL_TRY(orl_validation_load(source->log, source->scene, 0, p->size_divide, &s->targets));
    size_t n = s->targets.count;
    s->first = orl_array(source->log, n, sizeof *s->first);
    s->now.score = orl_array(source->log, n, sizeof *s->now.score);
    s->deciding_count = n < DECIDING_MAX ? n : DECIDING_MAX;
    s->validation_count = p->views && p->views < s->deciding_count ? p->views : s->deciding_count;
    s->most = orl_trim_has_budget(s)
                  ? (struct trim_loss){INFINITY, INFINITY, INFINITY}
                  : (struct trim_loss){p->tolerance_db, p->tolerance_ssim, p->worst_db};
    s->first_state.render = p->start->params;
    s->first_state.removed = orl_array(source->log, photos, sizeof *s->first_state.removed);
    ORL_TRY_MEMORY(s->first && s->now.score && s->first_state.removed);
    ORL_TRY(orl_point_ranking_make(source->gpu, source->scene, RANKED_VIEWS, p->progress, &source->ranking));
    ORL_TRY(orl_trim_state_copy(source->log, &s->first_state, photos, &s->now.state));
    ORL_TRY(orl_trim_order_photos(s));
    ORL_TRY(orl_trim_model_open(source, &s->now.state, &s->model));
    ORL_TRY(orl_trim_measure_all(s, true, &s->trim->before));
    ORL_TRY(orl_trim_time_first(s));
    s->now.bytes = orl_trim_model_bytes(s, s->model, &s->now.state);
    s->now.slower = 1;
    return ORL_OK;
}

// Fits the method's options at half the size, where a frame takes a quarter of the time.
static enum orl_result tune(struct trim_search *s)
{
    struct orl_search search;
    const struct orl_trim_params *p = s->params;
    const struct orl_search_params params = {
        .size_divide = TUNED_DIVIDE * p->size_divide, .views = TUNED_VIEWS,
        .gain_db = tuned_gain * p->tolerance_db, .budget_s = tuned_time * p->budget_s,
        .progress = p->progress};
    enum orl_result result = orl_search_run(s->source.gpu, s->model->renderer, s->source.scene,
                                            &params, p->start, NULL, &search);
    ORL_THEN(result, orl_trim_take_options(s, &search.best.params));
    orl_search_finish(&search);
    return result;
}

static enum orl_result write_and_look(struct trim_search *s)
{
    struct orl_trim *trim = s->trim;
    trim->choice = *s->params->start;
    trim->choice.params = s->now.state.render;
    ORL_TRY(orl_trim_write_scene(s->source.log, &s->model->scene, s->now.state.removed, &trim->choice,
                                 s->part));
    orl_trim_model_close(&s->model); // so that only the scene's own bytes are counted
    // Only now, when nothing can change any more, are held-out photographs looked at.
    ORL_TRY(look_at(s, s->source.scene->dir, &s->first_state.render, &trim->before));
    return look_at(s, s->part, &s->now.state.render, &trim->after);
}

static enum orl_result run(struct trim_search *s)
{
    ORL_TRY(start(s));
    if (s->params->tune)
        ORL_TRY(tune(s));
    ORL_TRY(orl_trim_climb(s));
    ORL_TRY(orl_trim_make_faster(s));
    ORL_TRY(orl_trim_confirm(s));
    ORL_TRY(write_and_look(s));
    orl_progress_report(s->params->progress, "trim", 1, 1, NULL);
    return ORL_OK;
}

static void finish(struct trim_search *s)
{
    orl_trim_model_close(&s->model);
    orl_point_ranking_finish(&s->source.ranking);
    orl_validation_finish(&s->targets);
    for (size_t i = 0; i < s->history_count; i++)
        orl_trim_standing_finish(&s->history[i]);
    orl_trim_standing_finish(&s->now);
    free(s->history);
    free(s->order);
    free(s->first);
    free(s->first_state.removed);
}

enum orl_result orl_trim_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                             const struct orl_trim_params *params, struct orl_trim *trim)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    memset(trim, 0, sizeof *trim);
    ORL_REQUIRE(log, params->size_divide >= 1 && params->size_divide <= ORL_SEARCH_DIVIDE_MAX);
    ORL_REQUIRE(log, params->out && *params->out);
    if (scene->lod)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%s: trim needs all points in memory, and they "
                        "are in points.lod: remove it, and where there is no points.ply, oriel "
                        "prepare --resume with a larger --max-ram writes one", scene->dir);
    struct orl_new_dir part = {.fd = -1};
    enum orl_result result = orl_new_dir_begin(log, params->out, &part);
    struct trim_search s = {.source = {.gpu = gpu, .log = log, .scene = scene},
                            .params = params, .trim = trim, .part = part.path,
                            .start_s = orl_time_s()};
    ORL_THEN(result, run(&s));
    finish(&s);
    ORL_THEN(result, orl_new_dir_finish(log, &part));
    orl_new_dir_abort(log, &part);
    if (result != ORL_OK)
        orl_trim_finish(trim);
    return result;
}

void orl_trim_finish(struct orl_trim *trim)
{
    free(trim->steps);
    memset(trim, 0, sizeof *trim);
}
