// oriel trim: the whole scene is measured, the search makes it smaller, and the result is written.
#include "eval/trim.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "core/memory.h"
#include "core/new_dir.h"
#include "core/process.h"
#include "eval/eval.h"
#include "eval/search.h"
#include "eval/trim_search.h"

enum { RANKED_VIEWS = 48, TUNED_VIEWS = 6, TUNED_DIVIDE = 2 };
enum { DECIDING_MAX = 48 }; // targets that decide on a step; all confirm the whole
// Least gain of a tuned option, as a share of the tolerance.
static const double tuned_gain = 0.1;
// Share of the time that tuning may take.
static const double tuned_time = 0.2;

// Opens a scene as every command does. Held-out photographs are compared with it, and what it takes
// on the device is counted.
static enum orl_result look_at(struct trim_search *s, const char *dir, const struct orl_choice *choice,
                               struct orl_trim_figures *figures)
{
    const struct orl_eval_params params = {.choice = choice, .divide = s->params->size_divide,
                                           .progress = s->params->progress};
    struct orl_scene *scene = NULL;
    struct orl_renderer *renderer = NULL;
    struct orl_eval eval = {0};
    enum orl_result result = orl_scene_open(s->log, dir, &scene);
    ORL_THEN(result, orl_renderer_create(s->gpu, scene, NULL, &renderer));
    if (result == ORL_OK && orl_heldout_count(scene) > 0)
        result = orl_eval_run(s->gpu, renderer, scene, &params, &eval);
    figures->held_psnr_db = eval.mean.metrics.psnr_db;
    figures->held_ssim = eval.mean.metrics.ssim;
    ORL_THEN(result, orl_renderer_draw(renderer, &s->targets.views[0].view, &choice->params, NULL, NULL));
    if (result == ORL_OK) {
        orl_trim_count_bytes(s->gpu, &figures->point_bytes, &figures->photo_bytes);
        figures->device_bytes = orl_gpu_bytes(s->gpu);
        figures->file_bytes = orl_trim_scene_file_bytes(scene);
    }
    orl_eval_finish(&eval);
    orl_renderer_destroy(&renderer);
    orl_scene_destroy(&scene);
    return result;
}

// --- the whole ---

// Moves `count` of the first `all` targets, evenly chosen, to the front.
static void move_to_front(struct orl_heldout *targets, size_t count, size_t all)
{
    for (size_t i = 0; i < count; i++) {
        const size_t from = (2 * i + 1) * all / (2 * count);
        const struct orl_heldout moved = targets[from];
        targets[from] = targets[i];
        targets[i] = moved;
    }
}

static enum orl_result start(struct trim_search *s)
{
    const struct orl_trim_params *p = s->params;
    ORL_TRY(orl_validation_load(s->log, s->scene, 0, p->size_divide, &s->targets));
    s->deciding_count = s->targets.count < DECIDING_MAX ? s->targets.count : DECIDING_MAX;
    s->validation_count = (size_t)p->views < s->deciding_count ? (size_t)p->views : s->deciding_count;
    move_to_front(s->targets.views, s->deciding_count, s->targets.count);
    move_to_front(s->targets.views, s->validation_count, s->deciding_count);
    s->most = orl_trim_has_budget(s)
                  ? (struct orl_score_loss){INFINITY, INFINITY, INFINITY}
                  : (struct orl_score_loss){p->tolerance_db, p->tolerance_ssim, p->worst_db};
    ORL_TRY(orl_point_ranking_make(s->gpu, s->scene, RANKED_VIEWS, p->progress, &s->ranking));
    ORL_TRY(orl_trim_order_photos(s));
    ORL_TRY(orl_trim_state_begin(s, ORL_TRIM_OPTION, &s->first));
    s->now = s->first;
    ORL_TRY(orl_trim_model_open(s, s->first));
    ORL_TRY(orl_trim_measure_all(s, &s->trim->before));
    ORL_TRY(orl_trim_time_first(s));
    s->first->step.bytes = orl_trim_model_bytes(s, s->first);
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
    enum orl_result result = orl_search_run(s->gpu, orl_trim_model_of(s->now)->renderer, s->scene,
                                            &params, p->start, NULL, &search);
    s->tuned = search.best.params;
    ORL_THEN(result, orl_trim_take_tuned(s));
    orl_search_finish(&search);
    return result;
}

static enum orl_result write_and_look(struct trim_search *s)
{
    struct orl_trim *trim = s->trim;
    trim->choice = *s->params->start;
    trim->choice.params = s->now->render;
    ORL_TRY(orl_trim_write_scene(s->log, &orl_trim_model_of(s->now)->scene, s->now->removed, &trim->choice, s->part));
    orl_trim_models_close(s->now); // so that only the scene's own bytes are counted
    // Only now, when nothing can change any more, are held-out photographs looked at.
    ORL_TRY(look_at(s, s->scene->dir, s->params->start, &trim->before));
    return look_at(s, s->part, &trim->choice, &trim->after);
}

static enum orl_result run(struct trim_search *s)
{
    ORL_TRY(start(s));
    if (!s->params->keep_options)
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
    while (s->now) {
        struct trim_state *before = s->now->before;
        orl_trim_state_destroy(&s->now);
        s->now = before;
    }
    orl_point_ranking_finish(&s->ranking);
    orl_validation_finish(&s->targets);
    free(s->order);
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
    enum orl_result result = orl_new_dir_begin(log, params->out, false, &part);
    struct trim_search s = {.gpu = gpu, .log = log, .scene = scene, .params = params, .trim = trim,
                            .part = part.path, .start_s = orl_time_s()};
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

// --- the report ---

static json_t *figures_json(const struct orl_trim_figures *f)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:f, s:f}", "points",
                     (json_int_t)f->points, "photographs", (json_int_t)f->photographs,
                     "point_bytes", (json_int_t)f->point_bytes, "photo_bytes",
                     (json_int_t)f->photo_bytes, "device_bytes", (json_int_t)f->device_bytes,
                     "file_bytes", (json_int_t)f->file_bytes, "frame_ms", f->frame_ms, "psnr_db",
                     f->psnr_db, "ssim", f->ssim, "worst_loss_db", f->worst_loss_db,
                     "held_psnr_db", f->held_psnr_db, "held_ssim", f->held_ssim);
}

static json_t *step_json(const struct orl_trim_step *s)
{
    return json_pack("{s:s, s:o, s:f, s:f, s:b, s:f, s:f, s:f, s:f}", "part",
                     orl_trim_part_names[s->part], "what", orl_json_string(s->what), "loss_db",
                     s->loss_db, "loss_ssim", s->loss_ssim, "taken", s->taken, "bytes", s->bytes,
                     "ms", s->ms, "total_loss_db", s->total_loss_db, "total_loss_ssim",
                     s->total_loss_ssim);
}

json_t *orl_trim_report(const struct orl_scene *scene, const char *device, const struct orl_trim *trim)
{
    json_t *steps = json_array();
    for (size_t i = 0; i < trim->step_count; i++)
        json_array_append_new(steps, step_json(&trim->steps[i]));
    return json_pack("{s:o, s:s, s:s, s:o, s:o, s:o, s:b, s:I, s:o}", "scene", orl_json_string(scene->dir), "device",
                     device, "method", trim->choice.method->name, "settings", orl_choice_settings(&trim->choice),
                     "before", figures_json(&trim->before), "after", figures_json(&trim->after), "complete",
                     trim->complete, "undone", (json_int_t)trim->undone, "steps", steps);
}
