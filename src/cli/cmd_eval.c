// oriel eval: held-out photographs against renderings.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/walk.h"
#include "core/memory.h"
#include "core/text.h"
#include "eval/eval.h"
#include "hdr/hdr.h"

struct options {
    const char *method, *json, *images, *merge, *truth, *textures, *vary, *plot;
    struct orl_names settings;
    int max_vram_mib;
    int walk, divide; // frames of a walk in place of held-out photographs; 0: none
};

struct job {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct options *options;
    bool verbose;
    struct orl_scene *scene;
    struct orl_gpu *gpu;
    struct orl_renderer *renderer; // NULL with --merge
    struct orl_hdr *hdr;           // of the method at hand, with --merge
    struct orl_truth truth;
    struct orl_names varied; // KEY=VALUE of --vary, each
    struct orl_eval *evals;  // one per method and varied setting
    size_t count;
};

// --- tables on stdout ---

static void print_figures(const struct orl_eval_view *view)
{
    const struct orl_metrics *m = &view->metrics;
    printf(" %7.2f %7.2f %7.2f  %.4f  %6.1f %6.1f  %.4f %9.1f\n", m->psnr_db, m->psnr_cc_db,
           m->psnr_covered_db, m->ssim, 100 * m->coverage, 100 * m->completeness, m->ncc_error,
           view->render_ms);
}

static void print_radiance(const struct orl_eval *eval)
{
    printf("%-24s %9s %9s %9s %9s\n", "radiance", "PU21 dB", "mu dB", "stops", "fitted");
    for (size_t i = 0; i <= eval->view_count; i++) {
        bool mean = i == eval->view_count;
        const struct orl_eval_view *view = mean ? &eval->mean : &eval->views[i];
        const struct orl_radiance_metrics *m = &view->radiance;
        printf("%-24s %9.2f %9.2f %9.4f %9.4f\n",
               mean ? "mean" : eval->scene->photos[view->photo].name, m->pu21_psnr_db,
               m->mu_psnr_db, m->log2_rmse, m->log2_rmse_fitted);
    }
}

static void print_table(const struct orl_eval *eval)
{
    printf("%s%s%s, %s\n", eval->method, eval->setting[0] ? " " : "", eval->setting,
           eval->device);
    printf("%-24s %11s %7s %7s %7s  %6s  %6s %6s  %6s %9s\n", "photograph", "size", "PSNR",
           "fitted", "covered", "SSIM", "cover%", "full%", "1-NCC", "ms");
    for (size_t i = 0; i < eval->view_count; i++) {
        const struct orl_eval_view *view = &eval->views[i];
        char size[32], shown[ORL_TEXT_SHOWN];
        snprintf(size, sizeof size, "%dx%d", view->width, view->height);
        orl_text_escape(eval->scene->photos[view->photo].name, shown, sizeof shown);
        printf("%-24s %11s", shown, size);
        print_figures(view);
    }
    printf("%-24s %11s", "mean", "");
    print_figures(&eval->mean);
    if (eval->has_truth)
        print_radiance(eval);
}

static void print_passes(const struct orl_eval *eval)
{
    printf("%-24s %9s\n", "pass", "ms");
    for (size_t i = 0; i < eval->pass_count; i++)
        printf("%-24s %9.2f\n", eval->passes[i].name, eval->passes[i].ms);
}

// --- the job ---

// varied: one of --vary, or NULL.
static enum orl_result apply_settings(const struct job *job, const char *varied,
                                      struct orl_render_params *render)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < job->options->settings.count; i++)
        result = orl_render_params_set(job->log, render, job->options->settings.items[i]);
    return result == ORL_OK && varied ? orl_render_params_set(job->log, render, varied) : result;
}

// KEY=A,B,C as KEY=A, KEY=B and KEY=C.
static enum orl_result list_varied(const struct orl_log *log, const char *text,
                                   struct orl_names *varied)
{
    const char *equals = strchr(text, '=');
    if (!equals)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--vary %s: must be KEY=VALUE,VALUE,..", text);
    enum orl_result result = ORL_OK;
    const char *value = equals + 1;
    while (result == ORL_OK) {
        int length = (int)strcspn(value, ",");
        char *setting = orl_format(log, "%.*s=%.*s", (int)(equals - text), text, length, value);
        result = setting ? orl_names_add(log, varied, setting) : ORL_ERR_MEMORY;
        free(setting);
        if (value[length] == '\0')
            break;
        value += length + 1;
    }
    return result;
}

static enum orl_result draw_radiance(void *priv, const struct orl_view *view,
                                     struct orl_frame *frame)
{
    return orl_hdr_draw(priv, view, NULL, frame);
}

static enum orl_result start_hdr(struct job *job, const struct orl_render_params *render)
{
    struct orl_hdr_params params = {ORL_HDR_DEFAULTS};
    params.render = *render;
    params.max_vram_bytes = (size_t)job->options->max_vram_mib << 20;
    enum orl_result result = orl_hdr_merge_find(job->log, job->options->merge, &params.merge);
    return result == ORL_OK ? orl_hdr_create(job->gpu, job->scene, &params, &job->hdr) : result;
}

static enum orl_result evaluate(struct job *job, const struct orl_method *method,
                                const char *varied)
{
    struct orl_render_params render;
    enum orl_result result = orl_render_params_tuned(job->log, method, job->scene, &render);
    if (result == ORL_OK)
        result = apply_settings(job, varied, &render);
    if (result != ORL_OK)
        return result;
    struct orl_eval_params params = {.method = method->name, .setting = varied,
                                           .render = &render,
                                           .image_dir = job->options->images,
                                           .progress = job->progress,
                                           .truth = job->options->truth ? &job->truth : NULL};
    struct orl_eval *eval = &job->evals[job->count];
    if (job->options->merge) {
        result = start_hdr(job, &render);
        if (result != ORL_OK)
            return result;
        params.draw_radiance = draw_radiance;
        params.draw_priv = job->hdr;
    }
    result = orl_eval_run(job->gpu, job->renderer, job->scene, &params, eval);
    orl_hdr_destroy(&job->hdr);
    if (result != ORL_OK)
        return result;
    job->count++;
    if (job->options->json && strcmp(job->options->json, "-") == 0)
        return ORL_OK;
    if (job->count > 1)
        printf("\n");
    print_table(eval);
    if (job->verbose)
        print_passes(eval);
    fflush(stdout);
    return ORL_OK;
}

static enum orl_result write_json(const struct job *job, bool array)
{
    const char *path = job->options->json;
    char *text = orl_eval_to_json(job->log, job->evals, job->count, array);
    if (!text)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    if (strcmp(path, "-") == 0)
        result = puts(text) < 0 || fflush(stdout) != 0
                     ? orl_fail(job->log, ORL_ERR_IO, "standard output: cannot write")
                     : ORL_OK;
    else
        result = orl_file_write(job->log, path, text, strlen(text));
    free(text);
    return result;
}

// Every method, one after the other, by held-out photographs or along a walk.
static enum orl_result measure(struct job *job, const struct orl_method *first, size_t methods,
                               bool all)
{
    const struct options *o = job->options;
    if (o->walk) {
        const struct walk_options walk = {.json = o->json, .images = o->images,
                                          .settings = &o->settings, .frames = o->walk,
                                          .divide = o->divide};
        return walk_run(job->gpu, job->renderer, job->scene, first, methods, all, &walk,
                        job->progress);
    }
    enum orl_result result = ORL_OK;
    size_t values = job->varied.count;
    for (size_t i = 0; i < methods && result == ORL_OK; i++) {
        if (values == 0)
            result = evaluate(job, &first[i], NULL);
        for (size_t k = 0; k < values && result == ORL_OK; k++)
            result = evaluate(job, &first[i], job->varied.items[k]);
    }
    if (result == ORL_OK && o->json)
        result = write_json(job, all || values > 0);
    if (result == ORL_OK && o->plot)
        result = orl_eval_plot(job->log, job->evals, job->count, o->plot);
    return result;
}

static enum orl_result check_together(const struct orl_log *log, const struct options *o)
{
    if (o->walk && (o->merge || o->truth))
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --walk compares frames with each other: "
                        "without --merge and --truth");
    if (o->walk && (o->vary || o->plot))
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --vary and --plot are of held-out "
                        "photographs: without --walk");
    if (o->vary && o->images)
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --vary makes several pictures of one name: "
                        "without --images");
    if (o->merge && strcmp(o->textures, "auto") != 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --merge keeps photographs as it needs them: "
                        "without --textures");
    return ORL_OK;
}

static enum orl_result run(struct job *job, const char *scene_dir,
                           const struct arg_common *common)
{
    enum orl_result result = check_together(job->log, job->options);
    if (result != ORL_OK)
        return result;
    bool all = strcmp(job->options->method, "all") == 0;
    const struct orl_method *first =
        all ? orl_methods : orl_method_find(job->log, job->options->method);
    size_t methods = 1;
    if (!first)
        return ORL_ERR_ARGUMENT;
    while (all && first[methods].name)
        methods++;
    if (job->options->vary)
        result = list_varied(job->log, job->options->vary, &job->varied);
    if (result != ORL_OK)
        return result;
    size_t values = job->varied.count ? job->varied.count : 1;
    job->evals = orl_array(job->log, methods * values, sizeof *job->evals);
    if (!job->evals)
        return ORL_ERR_MEMORY;
    struct orl_render_params tried = first->params; // wrong settings are found before the work
    result = apply_settings(job, NULL, &tried);
    for (size_t i = 0; result == ORL_OK && i < job->varied.count; i++)
        result = orl_render_params_set(job->log, &tried, job->varied.items[i]);
    struct orl_renderer_params limits = {
        .max_vram_bytes = (size_t)job->options->max_vram_mib << 20};
    if (result == ORL_OK)
        result = orl_textures_find(job->log, job->options->textures, &limits.textures);
    enum orl_hdr_merge merge;
    if (result == ORL_OK && job->options->merge)
        result = orl_hdr_merge_find(job->log, job->options->merge, &merge);
    if (result == ORL_OK)
        result = orl_scene_open(job->log, scene_dir, &job->scene);
    if (result == ORL_OK && !job->options->walk)
        result = orl_eval_check(job->log, job->scene);
    if (result == ORL_OK && job->options->truth)
        result = orl_truth_open(job->log, job->scene, job->options->truth, &job->truth);
    if (result == ORL_OK)
        result = orl_gpu_create(job->log,
                                &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                         .debug = common->verbose},
                                &job->gpu);
    if (result == ORL_OK && !job->options->merge)
        result = orl_renderer_create(job->gpu, job->scene, &limits, &job->renderer);
    return result == ORL_OK ? measure(job, first, methods, all) : result;
}

static void finish(struct job *job)
{
    for (size_t i = 0; i < job->count; i++)
        orl_eval_finish(&job->evals[i]);
    free(job->evals);
    orl_names_finish(&job->varied);
    orl_hdr_destroy(&job->hdr);
    orl_truth_finish(&job->truth);
    orl_renderer_destroy(&job->renderer);
    orl_gpu_destroy(&job->gpu);
    orl_scene_destroy(&job->scene);
}

int cmd_eval(int argc, char **argv)
{
    struct options o = {.method = orl_methods[0].name, .textures = "auto", .divide = 1};
    const struct arg_option table[] = {
        {"method", ARG_STRING, &o.method, "NAME", "a method, or all; default: the first", 0, 0},
        {"set", ARG_LIST, &o.settings, "KEY=VALUE", "change an option of the method", 0, 0},
        {"vary", ARG_STRING, &o.vary, "KEY=A,B,..", "once for each value of an option", 0, 0},
        {"plot", ARG_STRING, &o.plot, "FILE", "write a chart of accuracy against time (SVG)", 0,
         0},
        {"json", ARG_STRING, &o.json, "FILE", "write the figures as JSON; - for stdout", 0, 0},
        {"images", ARG_STRING, &o.images, "DIR", "write photographs, renderings, differences",
         0, 0},
        {"merge", ARG_STRING, &o.merge, "NAME",
         "blend as radiance, as oriel hdr does: fused or series", 0, 0},
        {"truth", ARG_STRING, &o.truth, "DIR",
         "compare with true radiance too; DIR is what oriel synth wrote", 0, 0},
        {"walk", ARG_INT, &o.walk, "N",
         "instead: a walk of N frames past the photographs that are not held out; how much "
         "each frame, warped, differs from the next", 2, 100000},
        {"divide", ARG_INT, &o.divide, "N", "of --walk: pictures at 1/N of their size; default 1",
         1, 64},
        {"textures", ARG_STRING, &o.textures, "KIND",
         "photographs on the device: auto (default), full, bc7, bc1; not with --merge", 0, 0},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory to plan for", 1, 1 << 20},
        {0},
    };
    const struct arg_command command = {
        "eval", "SCENE [--method NAME|all] [--walk N] [--json FILE] [--images DIR]",
        "Renders the photographs that were held out and says how close the renderings come.",
        table, 1, 1};
    struct arg_common common = {0};
    struct terminal terminal;
    const char *scene_dir;
    size_t count;
    int status;
    if (command_begin(&command, argc, argv, &common, &terminal, &scene_dir, &count, &status)) {
        struct job job = {.log = &terminal.log, .progress = &terminal.progress, .options = &o,
                          .verbose = common.verbose};
        status = command_status(run(&job, scene_dir, &common));
        finish(&job);
        terminal_finish(&terminal);
    }
    orl_names_finish(&o.settings);
    return status;
}
