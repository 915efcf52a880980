// oriel tune: fits a method's options to a scene's training photographs.
#include <stdio.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "eval/search.h"
#include "scene/tuned_settings.h"

#define TUNE_OPTIONS(ROW) \
    METHOD_OPTIONS(ROW) \
    ROW(keys, "only", LIST("KEY,KEY,.."), "tune these options; default: all that can be") \
    ROW(apply, "apply", FLAG, "keep the result in scene.json: render, eval and others use it") \
    ROW(fresh, "fresh", FLAG, "start from the method's values, not the scene's") \
    ORL_SEARCH_OPTIONS(ROW) \
    ROW(json, "json", TEXT("FILE"), "write result and trials as JSON; - for stdout") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
COMMAND_OPTIONS(tune_options, TUNE_OPTIONS)

static void print_trial(void *priv, const struct orl_trial *trial)
{
    (void)priv;
    char value[ORL_OPTION_TEXT] = "";
    if (trial->key)
        snprintf(value, sizeof value, "%g", trial->value);
    printf("%-18s %9s %9.3f %8.4f  %s\n", trial->key ? trial->key : "start", value, trial->psnr_db,
           trial->ssim, trial->kept ? "kept" : "");
    fflush(stdout);
}

static void print_result(const struct tune_options *o, const struct orl_search *search)
{
    json_t *settings = orl_choice_settings(&search->best), *value;
    const char *key;
    printf("%s: %.3f dB, was %.3f; %zu photographs at 1/%d, each rendered without itself%s\n",
           search->best.method->name, search->score.psnr_db, search->trials[0].psnr_db,
           search->validation.count, o->size_divide,
           search->complete ? "" : "; the budget ended the search");
    json_object_foreach(settings, key, value)
        if (json_is_string(value))
            printf("--set %s=%s\n", key, json_string_value(value));
        else
            printf("--set %s=%.6g\n", key, json_number_value(value));
    json_decref(settings);
}

static enum orl_result report(const struct orl_log *log, const struct tune_options *o,
                              const char *device, const struct orl_search *search)
{
    enum orl_result result = ORL_OK;
    if (!report_on_stdout(o->json))
        print_result(o, search);
    if (o->json)
        result = report_write(log, o->json, orl_search_report(search, device));
    if (result == ORL_OK && o->apply)
        result = orl_tuned_write(log, search->scene->dir, search->best.method->name, orl_search_record(search));
    return result;
}

static enum orl_result run_tune(struct call *call)
{
    const struct tune_options *o = call->options;
    const struct orl_log *log = call->log;
    struct orl_choice start = {0};
    struct orl_search search = {0};
    enum orl_result result = ORL_OK;
    if (o->method) // reports wrong settings before the long work
        result = orl_choice_make(log, NULL, ORL_SAMPLE_SRGB, o->method, &o->settings, &start);
    ORL_THEN(result, command_scene(call, NULL));
    if (result == ORL_OK) // unless `fresh`, starts from the scene's tuned values
        result = orl_choice_make(log, o->fresh ? NULL : call->scene, ORL_SAMPLE_SRGB,
                                 o->method ? o->method : orl_method_default(call->scene),
                                 &o->settings, &start);
    if (result == ORL_OK && o->apply) // before the long work, too
        result = orl_tuned_can_write(log, call->scene->dir);
    struct orl_renderer_params limits = {.max_vram_bytes = o->max_vram_bytes};
    ORL_THEN(result, command_renderer(call, &limits));
    const bool trials = !call->common->quiet && !report_on_stdout(o->json);
    const struct orl_search_params params = {ORL_SEARCH_OPTIONS(ORL_OPTION_COPY)
                                             .on_trial = trials ? print_trial : NULL,
                                             .progress = call->progress};
    if (result == ORL_OK && trials)
        printf("%-18s %9s %9s %8s\n", "option", "value", "PSNR dB", "SSIM");
    ORL_THEN(result, orl_search_run(call->gpu, call->renderer, call->scene, &params, &start, &o->keys, &search));
    ORL_THEN(result, report(log, o, orl_gpu_caps(call->gpu)->renderer, &search));
    orl_search_finish(&search);
    return result;
}

const struct command command_tune = {
    .name = "tune", .group = COMMAND_FIT,
    .brief = "fit a method's options to a scene",
    .usage = "SCENE [--method NAME] [--apply]",
    .summary = "Finds the values of a method's options with which training photographs come out best,\n"
               "each rendered from the others. Held-out photographs take no part.",
    COMMAND_TABLE(tune_options), .inputs_min = 1, .inputs_max = 1, .run = run_tune,
};
