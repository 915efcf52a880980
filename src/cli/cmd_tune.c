// oriel tune: fits a method's options to a scene's training photographs.
#include <stdio.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "eval/adapt.h"
#include "oriel/prepare_params.h"
#include "scene/tuned_settings.h"

enum { VIEWS = 16, ADAPT_BUDGET_S = 120 };

#define TUNE_OPTIONS(ROW) \
    METHOD_OPTIONS(ROW) \
    ROW(keys, "only", LIST("KEY,KEY,.."), "tune these options; default: all that can be") \
    ROW(apply, "apply", FLAG, "keep the result in scene.json: render, eval and others use it") \
    ROW(fresh, "fresh", FLAG, "start from the method's values, not the scene's") \
    ROW(adapt, "adapt", CHOICE(orl_adapt_effort, ORL_ADAPT_EFFORTS, ORL_ADAPT_NONE, "EFFORT"), \
        "choose the method, too, and keep the result, as prepare --adapt does") \
    ROW(budget_s, "budget", NUMBER(0, 0, 1e6, "SECONDS"), \
        "start no trial after so long; default: none, and 120 with --adapt long") \
    ROW(views, "views", INT(0, 1, 100000, "N"), \
        "photographs to compare with, at most; default 16, and 6 with --adapt") \
    ROW(size_divide, "size-divide", INT(1, 1, 16, "N"), "compare at 1/N of their size") \
    ROW(gain_db, "gain", NUMBER(0.01, 0, 10, "DB"), "a change must bring so much") \
    ROW(json, "json", TEXT("FILE"), "write result and trials as JSON") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
COMMAND_OPTIONS(tune_options, TUNE_OPTIONS)

static void print_trial(void *priv, const struct orl_trial *trial)
{
    (void)priv;
    printf("%-18s %9s %9.3f %8.4f  %s\n", trial->key ? trial->key : "start", trial->value,
           trial->psnr_db, trial->ssim, trial->kept ? "kept" : "");
    fflush(stdout);
}

static enum orl_result report(const struct orl_log *log, const struct tune_options *o,
                              const char *device, const struct orl_search *search)
{
    const struct orl_method *method = search->best.method;
    json_t *settings = orl_choice_settings(method, &search->best.params), *value;
    const char *key;
    printf("%s: %.3f dB, was %.3f; %zu photographs at 1/%d, each rendered without itself%s\n",
           method->name, search->score.psnr_db, search->trials[0].psnr_db,
           search->validation.count, o->size_divide,
           search->complete ? "" : "; the budget ended the search");
    json_object_foreach(settings, key, value)
        if (json_is_string(value))
            printf("--set %s=%s\n", key, json_string_value(value));
        else
            printf("--set %s=%.6g\n", key, json_number_value(value));
    enum orl_result result = ORL_OK;
    if (o->json)
        result = orl_search_write_json(log, o->json, device, search);
    if (result == ORL_OK && o->apply)
        result = orl_tuned_write(log, search->scene->dir, method->name, orl_search_record(search));
    json_decref(settings);
    return result;
}

// As the stage adapt of prepare does.
static enum orl_result adapt(const struct terminal *terminal, const struct tune_options *o,
                             const struct common_options *common, const char *dir)
{
    const struct orl_log *log = &terminal->log;
    if (o->method || o->settings.count || o->keys.count || o->fresh || o->json)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "tune: --adapt chooses the method and its options itself: without "
                        "--method, --set, --only, --fresh and --json");
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    struct orl_adapt found = {0};
    const struct orl_adapt_params params = {
        .search = o->adapt == ORL_ADAPT_LONG,
        .views = (size_t)(o->views ? o->views : ORL_ADAPT_VIEWS), .size_divide = o->size_divide,
        .budget_s = o->budget_s > 0 ? o->budget_s : ADAPT_BUDGET_S,
        .progress = &terminal->progress};
    enum orl_result result = orl_scene_open(log, dir, &scene);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    if (result == ORL_OK)
        result = orl_adapt_run(gpu, scene, &params, &found);
    if (result == ORL_OK)
        result = orl_adapt_store(log, dir, &found);
    for (size_t i = 0; result == ORL_OK && i < found.row_count; i++)
        printf("%-14s %7.2f dB %7.4f%s\n", found.rows[i].method->name, found.rows[i].psnr_db,
               found.rows[i].ssim, i == found.chosen ? "  chosen" : "");
    if (result == ORL_OK)
        printf("%-14s %7.2f dB %7.4f\n%-14s %7.2f dB %7.4f%s\n", "plain", found.plain_db,
               found.plain_ssim, "adapted", found.tuned_db, found.tuned_ssim,
               found.complete ? "" : "  (the budget ran out)");
    orl_gpu_destroy(&gpu);
    orl_scene_destroy(&scene);
    return result;
}

static enum orl_result run_tune(struct terminal *terminal, const void *options,
                                const struct common_options *common, const char *const *inputs)
{
    const struct tune_options *o = options;
    if (o->adapt != ORL_ADAPT_NONE)
        return adapt(terminal, o, common, inputs[0]);
    const struct orl_log *log = &terminal->log;
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    struct orl_renderer *renderer = NULL;
    struct orl_choice start = {0};
    struct orl_search search = {0};
    enum orl_result result = ORL_OK;
    if (o->method) // reports wrong settings before the long work
        result = orl_choice_make(log, NULL, ORL_SAMPLE_SRGB, o->method, &o->settings, &start);
    if (result == ORL_OK)
        result = orl_scene_open(log, inputs[0], &scene);
    if (result == ORL_OK) // unless `fresh`, starts from the scene's tuned values
        result = orl_choice_make(log, o->fresh ? NULL : scene, ORL_SAMPLE_SRGB,
                                 o->method ? o->method : orl_method_default(scene),
                                 &o->settings, &start);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    struct orl_renderer_params limits = {.max_vram_bytes = o->max_vram_bytes};
    if (result == ORL_OK)
        result = orl_renderer_create(gpu, scene, &limits, &renderer);
    const struct orl_search_params params = {
        .size_divide = o->size_divide, .views = (size_t)(o->views ? o->views : VIEWS), .gain_db = o->gain_db, .budget_s = o->budget_s,
        .on_trial = common->quiet ? NULL : print_trial, .progress = &terminal->progress};
    if (result == ORL_OK && !common->quiet)
        printf("%-18s %9s %9s %8s\n", "option", "value", "PSNR dB", "SSIM");
    if (result == ORL_OK)
        result = orl_search_run(gpu, renderer, scene, &params, &start, &o->keys, &search);
    if (result == ORL_OK)
        result = report(log, o, orl_gpu_caps(gpu)->renderer, &search);
    orl_search_finish(&search);
    orl_renderer_destroy(&renderer);
    orl_gpu_destroy(&gpu);
    orl_scene_destroy(&scene);
    return result;
}

const struct command command_tune = {
    .name = "tune", .group = COMMAND_FIT,
    .brief = "fit a method's options to a scene",
    .usage = "SCENE [--method NAME] [--apply | --adapt short|long]",
    .summary = "Finds the values of a method's options with which training photographs come out best,\n"
               "each rendered from the others. Held-out photographs take no part.",
    COMMAND_TABLE(tune_options), .inputs_min = 1, .inputs_max = 1, .run = run_tune,
};
