// oriel tune: fits a method's options to a scene's training photographs.
#include <stdio.h>

#include "cli/commands.h"
#include "eval/adapt.h"
#include "eval/tune_json.h"
#include "oriel/prepare_params.h"

enum { VIEWS = 16, ADAPT_BUDGET_S = 120 };

struct options {
    const char *method, *json;
    struct orl_names settings, keys;
    int size_divide, views, max_vram_mib;
    double budget_s, gain_db;
    struct arg_enum adapt;
    bool apply, fresh;
};

static void print_trial(void *priv, const struct orl_tune_trial *trial)
{
    (void)priv;
    if (trial->key)
        printf("%-18s %9.4g", trial->key, trial->value);
    else
        printf("%-18s %9s", "start", "");
    printf(" %9.3f %8.4f  %s\n", trial->psnr_db, trial->ssim, trial->kept ? "kept" : "");
    fflush(stdout);
}

static enum orl_result report(const struct orl_log *log, const struct options *o,
                              const struct orl_scene *scene, const char *device,
                              const struct orl_method *method, const struct orl_tune *tune)
{
    json_t *settings = orl_choice_settings(method, &tune->best), *value;
    const char *key;
    printf("%s: %.3f dB, was %.3f; %zu photographs at 1/%d, each rendered without itself%s\n",
           method->name, tune->best_db, tune->start_db, tune->views, o->size_divide,
           tune->complete ? "" : "; the budget ended the search");
    json_object_foreach(settings, key, value)
        if (json_is_string(value))
            printf("--set %s=%s\n", key, json_string_value(value));
        else
            printf("--set %s=%.6g\n", key, json_number_value(value));
    enum orl_result result = ORL_OK;
    if (o->json)
        result = orl_tune_write_json(log, o->json, scene, method, device, o->size_divide, tune);
    if (result == ORL_OK && o->apply)
        result = orl_tune_apply(log, scene, method, o->size_divide, tune);
    json_decref(settings);
    return result;
}

// As the stage adapt of prepare does.
static enum orl_result adapt(const struct terminal *terminal, const struct options *o,
                             const struct arg_common *common, const char *dir)
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
        .search = o->adapt.value == ORL_ADAPT_LONG,
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

static enum orl_result run(const struct terminal *terminal, const void *options,
                           const struct arg_common *common, const char *dir)
{
    const struct options *o = options;
    if (o->adapt.value != ORL_ADAPT_NONE)
        return adapt(terminal, o, common, dir);
    const struct orl_log *log = &terminal->log;
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    struct orl_renderer *renderer = NULL;
    struct orl_choice start = {0};
    struct orl_tune tune = {0};
    enum orl_result result = ORL_OK;
    if (o->method) // reports wrong settings before the long work
        result = orl_choice_make(log, NULL, ORL_SAMPLE_SRGB, o->method, &o->settings, &start);
    if (result == ORL_OK)
        result = orl_scene_open(log, dir, &scene);
    if (result == ORL_OK) // unless `fresh`, starts from the scene's tuned values
        result = orl_choice_make(log, o->fresh ? NULL : scene, ORL_SAMPLE_SRGB,
                                 o->method ? o->method : orl_method_default(scene),
                                 &o->settings, &start);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    struct orl_renderer_params limits = {.max_vram_bytes = (size_t)o->max_vram_mib << 20};
    if (result == ORL_OK)
        result = orl_renderer_create(gpu, scene, &limits, &renderer);
    const struct orl_tune_params params = {
        .method = start.method ? start.method->name : NULL, .start = &start.params,
        .keys = &o->keys, .size_divide = o->size_divide,
        .views = (size_t)(o->views ? o->views : VIEWS), .gain_db = o->gain_db, .budget_s = o->budget_s,
        .on_trial = common->quiet ? NULL : print_trial, .progress = &terminal->progress};
    if (result == ORL_OK && !common->quiet)
        printf("%-18s %9s %9s %8s\n", "option", "value", "PSNR dB", "SSIM");
    if (result == ORL_OK)
        result = orl_tune_run(gpu, renderer, scene, &params, &tune);
    if (result == ORL_OK)
        result = report(log, o, scene, orl_gpu_caps(gpu)->renderer, start.method, &tune);
    orl_tune_finish(&tune);
    orl_renderer_destroy(&renderer);
    orl_gpu_destroy(&gpu);
    orl_scene_destroy(&scene);
    return result;
}

int cmd_tune(int argc, char **argv)
{
    struct options o = {.size_divide = 1, .gain_db = 0.01,
                        .adapt = {orl_adapt_effort_names, ORL_ADAPT_NONE}};
    const struct arg_option table[] = {
        {"method", ARG_STRING, &o.method, "NAME", "a method; default: the scene's, or the first", 0,
         0},
        {"set", ARG_LIST, &o.settings, "KEY=VALUE", "start from another value", 0, 0},
        {"only", ARG_LIST, &o.keys, "KEY,KEY,..", "tune these options; default: all that can be",
         0, 0},
        {"apply", ARG_FLAG, &o.apply, NULL,
         "keep the result in scene.json: render, eval and others use it", 0, 0},
        {"fresh", ARG_FLAG, &o.fresh, NULL, "start from the method's values, not the scene's", 0,
         0},
        {"adapt", ARG_ENUM, &o.adapt, "EFFORT",
         "choose the method, too, and keep the result, as prepare --adapt does", 0, 0},
        {"budget", ARG_NUMBER, &o.budget_s, "SECONDS",
         "start no trial after so long; default: none, and 120 with --adapt long", 0, 1e6},
        {"views", ARG_INT, &o.views, "N",
         "photographs to compare with, at most; default 16, and 6 with --adapt", 1, 100000},
        {"size-divide", ARG_INT, &o.size_divide, "N", "compare at 1/N of their size; default 1", 1,
         16},
        {"gain", ARG_NUMBER, &o.gain_db, "DB", "a change must bring so much; default 0.01", 0, 10},
        {"json", ARG_STRING, &o.json, "FILE", "write result and trials as JSON", 0, 0},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory to plan for", 1, 1 << 20},
        {0},
    };
    const struct arg_command command = {
        "tune", "SCENE [--method NAME] [--apply | --adapt short|long]",
        "Finds the values of a method's options with which training photographs come out best,\n"
        "each rendered from the others. Held-out photographs take no part.", table, 1, 1};
    int status = command_main(&command, argc, argv, run, &o);
    orl_names_finish(&o.settings);
    orl_names_finish(&o.keys);
    return status;
}
