// oriel trim: the search makes the scene smaller, and the result is written and compared with the whole: an ordinary scene
// folder, whose scene.json is written last.
#include "eval/trim.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/new_dir.h"
#include "core/process.h"
#include "eval/eval.h"
#include "eval/search.h"
#include "eval/trim_search.h"
#include "scene/subset.h"
#include "scene/tuned_settings.h"

// --- what a scene takes ---

static size_t file_size(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode) ? (size_t)status.st_size : 0;
}

// Bytes of the scene's points, cameras, photographs that are not held out and their masks, on disk.
static size_t file_bytes(const struct orl_scene *scene)
{
    static const char *const names[] = {"points.ply", "sparse/cameras.bin", "sparse/images.bin",
                                        "sparse/points3D.bin", "mesh.ply"};
    size_t bytes = 0;
    for (size_t i = 0; i < ORL_COUNT(names); i++)
        bytes += file_size(ORL_PATH(scene->dir, "%s", names[i]));
    for (size_t i = 0; i < scene->photo_count; i++)
        if (!scene->photos[i].test)
            bytes += file_size(orl_scene_file(scene, i, ORL_FILE_PHOTO).text) +
                     file_size(orl_scene_file(scene, i, ORL_FILE_MASK).text);
    return bytes;
}

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
        figures->file_bytes = file_bytes(scene);
    }
    orl_eval_finish(&eval);
    orl_renderer_destroy(&renderer);
    orl_scene_destroy(&scene);
    return result;
}

// --- the scene that is written ---

// Lists the photographs that trimming removed under "left_out".
static void list_left_out(const struct orl_subset *subset)
{
    const struct orl_scene *scene = subset->scene;
    json_t *left = json_object_get(subset->manifest, "left_out");
    if (!json_is_array(left)) {
        left = json_array();
        json_object_set_new(subset->manifest, "left_out", left);
    }
    for (size_t i = 0; i < scene->photo_count; i++)
        if (!subset->keep[i])
            json_array_append_new(left, json_pack("{s:s, s:s}", "name", scene->photos[i].name,
                                                  "why", "trimmed"));
}

static enum orl_result write_manifest(const struct orl_subset *subset, const struct orl_choice *choice)
{
    const struct orl_scene *scene = subset->scene;
    json_t *root = subset->manifest, *tuned = json_object_get(root, "tuned");
    json_t *render = orl_defaults_json(&scene->defaults);
    const char *path = ORL_PATH(subset->dir, "scene.json"), *method = choice->method->name;
    json_object_set_new(render, "method", json_string(method));
    if (!json_is_object(tuned)) {
        tuned = json_object();
        json_object_set_new(root, "tuned", tuned);
    }
    json_object_set_new(tuned, method, json_pack("{s:o}", "settings", orl_choice_settings(choice)));
    list_left_out(subset);
    json_object_set_new(json_object_get(root, "counts"), "points", json_integer((json_int_t)scene->points.count));
    json_object_set_new(root, "trimmed_from", orl_json_string(scene->dir));
    return json_object_set_new(root, "render", render) == 0
               ? orl_json_write(subset->log, path, root)
               : orl_fail(subset->log, ORL_ERR_MEMORY, "%s: no memory for it", path);
}

// Writes the scene in the search's state to the folder `out`.
static enum orl_result write_scene(const struct trim_search *s, const struct orl_choice *choice, const char *out)
{
    const struct orl_scene *scene = &orl_trim_model_of(s->now)->scene;
    bool *keep = orl_array(s->log, scene->photo_count, sizeof *keep);
    struct orl_subset subset = {.log = s->log, .scene = scene, .keep = keep, .points = &scene->points, .dir = out};
    for (size_t i = 0; keep && i < scene->photo_count; i++)
        keep[i] = !s->now->removed[i];
    enum orl_result result = keep ? orl_dir_make(s->log, out) : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_subset_begin(&subset));
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (keep[i])
            result = orl_subset_copy_photo(&subset, i);
    ORL_THEN(result, write_manifest(&subset, choice));
    json_decref(subset.manifest);
    free(keep);
    return result;
}

// --- the whole ---

static enum orl_result run(struct trim_search *s, const char *out)
{
    struct orl_trim *trim = s->trim;
    ORL_TRY(orl_trim_search(s));
    trim->choice = *s->params->start;
    trim->choice.params = s->now->render;
    ORL_TRY(write_scene(s, &trim->choice, out));
    orl_trim_models_close(s->now); // so that only the scene's own bytes are counted
    // Only now, when nothing can change any more, are held-out photographs looked at.
    ORL_TRY(look_at(s, s->scene->dir, s->params->start, &trim->before));
    ORL_TRY(look_at(s, out, &trim->choice, &trim->after));
    orl_progress_report(s->params->progress, "trim", 1, 1, NULL);
    return ORL_OK;
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
                            .start_s = orl_time_s()};
    ORL_THEN(result, run(&s, part.path));
    orl_trim_search_finish(&s);
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
