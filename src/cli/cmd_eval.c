// oriel eval: compares held-out photographs with renderings.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "core/memory.h"
#include "core/text.h"
#include "eval/eval.h"
#include "eval/stability.h"
#include "oriel/hdr.h"

#define EVAL_OPTIONS(ROW) \
    ROW(method, "method", TEXT("NAME"), \
        "a method, all, or paired: all, and those of papers again on the proxy of oriel; default: " \
        "the scene's, or else the first of oriel methods") \
    ROW(settings, "set", LIST("KEY=VALUE"), "change an option of the method") \
    ROW(vary, "vary", TEXT("KEY=A,B,.."), "once for each value of an option") \
    ROW(time_step, "frame", INT(-1, 0, 1 << 20, "N"), \
        "time step of a sequence, from 0; default: the first") \
    ROW(json, "json", TEXT("FILE"), "write the figures as JSON; - for stdout") \
    ROW(images, "images", TEXT("DIR"), "write photographs, renderings, differences") \
    ROW(merge, "merge", MAYBE(ORL_HDR_MERGES, "NAME"), "blend as radiance, as oriel hdr does") \
    ROW(truth, "truth", TEXT("DIR"), \
        "compare with true radiance too; DIR is what oriel synth wrote") \
    ROW(walk, "walk", INT(0, 2, 100000, "N"), \
        "instead: a walk of N frames past the photographs that are not held out; how much each " \
        "frame, warped, differs from the next") \
    ROW(divide, "divide", INT(1, 1, 64, "N"), \
        "pictures at 1/N of their size, as small screens show them") \
    ROW(textures, "textures", CHOICE(orl_textures, ORL_TEXTURES, ORL_TEXTURES_AUTO, "KIND"), \
        "photographs on the device; not with --merge") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
COMMAND_OPTIONS(eval_options, EVAL_OPTIONS)

struct job {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct eval_options *options;
    bool verbose;
    struct orl_scene *scene;
    struct orl_gpu *gpu;
    struct orl_renderer *renderer; // NULL with --merge
    struct orl_hdr *hdr;           // of the current method, with --merge
    struct orl_truth truth;
    struct orl_choices choices;
    struct orl_eval *evals; // one per choice
    size_t count;
};

// --- tables on stdout ---

static void print_figures(const struct orl_eval_view *view)
{
    const struct orl_metrics *m = &view->metrics;
    printf(" %7.2f %7.2f %7.2f  %.4f  %.4f  %6.1f  %6.1f %6.1f  %.4f %9.1f\n", m->psnr_db,
           m->psnr_cc_db, m->psnr_covered_db, m->ssim, view->flip, m->crumbs, 100 * m->coverage,
           100 * m->completeness, m->ncc_error, view->render_ms);
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
    printf("%-24s %11s %7s %7s %7s  %6s  %6s  %6s  %6s %6s  %6s %9s\n", "photograph", "size", "PSNR",
           "fitted", "covered", "SSIM", "FLIP", "crumbs", "cover%", "full%", "1-NCC", "ms");
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

static void print_walk_row(void *priv, const struct orl_stability *s)
{
    const struct orl_stability_step *all = &s->all;
    char block[64], jump[64];
    bool *first = priv;
    if (*first)
        printf("walk of %zu frames of %dx%d, %s; differences of one frame, warped, to the next, "
               "in 8-bit values\n%-14s %8s %7s %7s %7s  %7s %22s  %15s %9s\n", s->step_count + 1,
               s->width, s->height, s->device, "method", "seen%", "mean", "floor", "p99",
               "blocks", "worst block", "worst jump", "ms");
    *first = false;
    snprintf(block, sizeof block, "%.2f %zu:%d,%d", all->block_worst, s->worst_block_step + 1,
             all->block_x, all->block_y);
    snprintf(jump, sizeof jump, "%.2f %zu", all->jump, s->worst_jump_step + 1);
    printf("%-14s %8.1f %7.3f %7.3f %7.2f  %7.3f %22s  %15s %9.1f\n", s->method,
           100 * all->compared, all->mean, all->floor, all->p99, all->block_mean, block, jump,
           s->render_ms);
    fflush(stdout);
}

// --- the job ---

static enum orl_result draw_radiance(void *priv, const struct orl_view *view,
                                     struct orl_frame *frame)
{
    return orl_hdr_draw(priv, view, NULL, frame);
}

static enum orl_result start_hdr(struct job *job, const struct orl_render_params *render)
{
    struct orl_hdr_params params = {ORL_HDR_DEFAULTS};
    params.render = *render;
    params.max_vram_bytes = job->options->max_vram_bytes;
    params.merge = (enum orl_hdr_merge)job->options->merge;
    return orl_hdr_create(job->gpu, job->scene, &params, &job->hdr);
}

static enum orl_result evaluate(struct job *job, const struct orl_choice *choice)
{
    struct orl_eval_params params = {.method = choice->method->name, .setting = choice->setting,
                                     .render = &choice->params,
                                     .image_dir = job->options->images,
                                     .divide = job->options->divide,
                                     .progress = job->progress,
                                     .truth = job->options->truth ? &job->truth : NULL};
    struct orl_eval *eval = &job->evals[job->count];
    if (job->options->merge >= 0) {
        enum orl_result result = start_hdr(job, &choice->params);
        if (result != ORL_OK)
            return result;
        params.draw_radiance = draw_radiance;
        params.draw_priv = job->hdr;
    }
    enum orl_result result = orl_eval_run(job->gpu, job->renderer, job->scene, &params, eval);
    orl_hdr_destroy(&job->hdr);
    if (result != ORL_OK)
        return result;
    job->count++;
    if (report_on_stdout(job->options->json))
        return ORL_OK;
    if (job->count > 1)
        printf("\n");
    print_table(eval);
    if (job->verbose)
        print_passes(eval);
    fflush(stdout);
    return ORL_OK;
}

static enum orl_result measure_walk(struct job *job, bool array)
{
    const struct eval_options *o = job->options;
    bool first = true;
    const struct orl_walk_params params = {
        .choices = job->choices.items, .choice_count = job->choices.count, .frames = o->walk,
        .divide = o->divide, .image_dir = o->images, .priv = &first,
        .on_result = report_on_stdout(o->json) ? NULL : print_walk_row,
        .progress = job->progress};
    struct orl_stability *all = orl_array(job->log, job->choices.count, sizeof *all);
    if (!all)
        return ORL_ERR_MEMORY;
    enum orl_result result =
        orl_stability_walk_all(job->gpu, job->renderer, job->scene, &params, all);
    if (result == ORL_OK && o->json)
        result = report_write(job->log, o->json, orl_stability_to_json(
            job->log, job->scene, all, job->choices.count, array));
    for (size_t i = 0; result == ORL_OK && i < job->choices.count; i++)
        orl_stability_finish(&all[i]);
    free(all);
    return result;
}

static enum orl_result measure_heldout(struct job *job, bool array)
{
    const struct eval_options *o = job->options;
    job->evals = orl_array(job->log, job->choices.count, sizeof *job->evals);
    enum orl_result result = job->evals ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; i < job->choices.count && result == ORL_OK; i++)
        result = evaluate(job, &job->choices.items[i]);
    if (result == ORL_OK && o->json)
        result = report_write(job->log, o->json,
                              orl_eval_to_json(job->log, job->evals, job->count, array));
    return result;
}

static enum orl_result check_together(const struct orl_log *log, const struct eval_options *o)
{
    if (o->walk && (o->merge >= 0 || o->truth))
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --walk compares frames with each other: "
                        "without --merge and --truth");
    if (o->walk && o->vary)
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --vary is of held-out photographs: without "
                        "--walk");
    if (o->truth && o->divide > 1)
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --truth is of the photographs' size: without "
                        "--divide");
    if (o->vary && o->images)
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --vary makes several pictures of one name: "
                        "without --images");
    if (o->merge >= 0 && o->textures != ORL_TEXTURES_AUTO)
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --merge keeps photographs as it needs them: "
                        "without --textures");
    return ORL_OK;
}

static enum orl_result choose(struct job *job, const struct orl_scene *scene)
{
    const struct eval_options *o = job->options;
    struct orl_names methods = {0};
    enum orl_result result =
        o->method ? orl_names_add(job->log, &methods, o->method) : ORL_OK;
    orl_choices_finish(&job->choices);
    if (result == ORL_OK)
        result = orl_choices_make(job->log, scene,
                                  o->merge < 0 ? ORL_SAMPLE_SRGB : ORL_SAMPLE_RADIANCE,
                                  &methods, &o->settings, o->vary, &job->choices);
    orl_names_finish(&methods);
    return result;
}

static enum orl_result evaluate_scene(struct job *job, const char *scene_dir,
                                      const struct common_options *common)
{
    const struct eval_options *o = job->options;
    const struct orl_renderer_params limits = {
        .max_vram_bytes = o->max_vram_bytes,
        .textures = o->textures,
        .progress = job->progress};
    enum orl_result result = check_together(job->log, o);
    if (result == ORL_OK && o->method) // reports wrong settings before the long work
        result = choose(job, NULL);
    if (result == ORL_OK)
        result = orl_scene_open(job->log, scene_dir, &job->scene);
    if (result == ORL_OK && o->time_step >= 0)
        result = orl_scene_set_frame(job->log, job->scene, o->time_step);
    if (result == ORL_OK)
        result = choose(job, job->scene);
    if (result == ORL_OK && !o->walk)
        result = orl_eval_check(job->log, job->scene);
    if (result == ORL_OK && o->truth)
        result = orl_truth_open(job->log, job->scene, o->truth, &job->truth);
    if (result == ORL_OK)
        result = orl_gpu_create(job->log,
                                &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                         .debug = common->verbose},
                                &job->gpu);
    if (result == ORL_OK && o->merge < 0)
        result = orl_renderer_create(job->gpu, job->scene, &limits, &job->renderer);
    if (result != ORL_OK)
        return result;
    bool array = o->vary || (o->method && (strcmp(o->method, "all") == 0 ||
                                           strcmp(o->method, "paired") == 0));
    return o->walk ? measure_walk(job, array) : measure_heldout(job, array);
}

static void finish(struct job *job)
{
    for (size_t i = 0; i < job->count; i++)
        orl_eval_finish(&job->evals[i]);
    free(job->evals);
    orl_choices_finish(&job->choices);
    orl_hdr_destroy(&job->hdr);
    orl_truth_finish(&job->truth);
    orl_renderer_destroy(&job->renderer);
    orl_gpu_destroy(&job->gpu);
    orl_scene_destroy(&job->scene);
}

static enum orl_result run_eval(struct terminal *terminal, const void *options,
                                const struct common_options *common, const char *const *inputs)
{
    struct job job = {.log = &terminal->log, .progress = &terminal->progress, .options = options,
                      .verbose = common->verbose};
    enum orl_result result = evaluate_scene(&job, inputs[0], common);
    finish(&job);
    return result;
}

const struct command command_eval = {
    .name = "eval", .group = COMMAND_MEASURE,
    .brief = "compare renderings with held-out photographs",
    .usage = "SCENE [--method NAME|all] [--walk N] [--json FILE] [--images DIR]",
    .summary = "Renders the photographs that were held out and says how close the renderings come.",
    COMMAND_TABLE(eval_options), .inputs_min = 1, .inputs_max = 1, .run = run_eval,
};
