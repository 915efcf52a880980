// oriel eval: compares held-out photographs with renderings.
#include <stdio.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "core/text.h"
#include "eval/eval.h"
#include "eval/stability.h"
#include "oriel/hdr.h"

#define EVAL_OPTIONS(ROW) \
    ROW(methods, "method", LIST("NAME"), \
        "methods, or all; with paired also those of papers again on the proxy of oriel; default: " \
        "the scene's, or else the first of oriel methods") \
    ROW(settings, "set", LIST("KEY=VALUE"), "change an option of the method") \
    ROW(vary, "vary", TEXT("KEY=A,B,.."), "once for each value of an option") \
    ROW(time_step, "frame", INT(-1, 0, 1 << 20, "N"), \
        "time step of a sequence, from 0; default: the first") \
    ROW(json, "json", TEXT("FILE"), "write the figures as JSON; - for stdout") \
    ROW(images, "images", TEXT("DIR"), "write photographs, renderings, differences") \
    ROW(pictures, "pictures", TEXT("DIR"), \
        "measure another program's pictures of the held-out views instead: DIR/PHOTO.png or .jpg") \
    ROW(merge, "merge", MAYBE(ORL_HDR_MERGES, "NAME"), "blend as radiance, as oriel hdr does") \
    ROW(truth, "truth", TEXT("DIR"), \
        "compare with true radiance too; DIR is what oriel synth wrote") \
    ROW(walk, "walk", INT(0, 2, 100000, "N"), \
        "instead: a walk of N frames past the photographs that are not held out; how much each " \
        "frame, warped, differs from the next") \
    ROW(path, "path", TEXT("FILE"), "instead: along this path, as of render --path") \
    ROW(views, "views", INT(0, 1, 100000, "N"), "held-out photographs, at most; default: all") \
    ROW(divide, "divide", INT(1, 1, 64, "N"), \
        "pictures at 1/N of their size, as small screens show them") \
    ROW(textures, "textures", CHOICE(orl_textures, ORL_TEXTURES, ORL_TEXTURES_AUTO, "KIND"), \
        "photographs on the device; not with --merge") \
    ROW(photo_divide, "photo-divide", INT(1, 1, 64, "N"), \
        "keep them at 1/N of their size or less; not with --merge") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
COMMAND_OPTIONS(eval_options, EVAL_OPTIONS)

struct job {
    struct call *call;           // its renderer: of the current method; NULL with --merge
    const struct eval_options *options;
    struct orl_truth truth;
    struct orl_choices choices;
    json_t *reports;             // one per choice
};

// --- tables on stdout ---

// A head, then a row for each view and their mean.
static void print_rows(const struct orl_eval *eval, const char *head,
                       enum orl_figure_group group)
{
    printf("%-24s %11s", head, group == ORL_FIGURES_PICTURE ? "size" : "");
    for (const struct orl_figure *f = orl_figures; f->name; f++)
        if (f->title && f->group == group)
            printf(" %*s", f->width, f->title);
    for (size_t i = 0; i <= eval->view_count; i++) {
        bool mean = i == eval->view_count;
        const struct orl_eval_view *view = mean ? &eval->mean : &eval->views[i];
        char size[32] = "", shown[ORL_TEXT_SHOWN] = "mean";
        if (!mean) {
            snprintf(size, sizeof size, "%dx%d", view->width, view->height);
            orl_text_escape(eval->scene->photos[view->photo].name, shown, sizeof shown);
        }
        printf("\n%-24s %11s", shown, size);
        for (const struct orl_figure *f = orl_figures; f->name; f++)
            if (f->title && f->group == group)
                printf(" %*.*f", f->width, f->digits, f->scale * orl_figure_value(f, view));
    }
    printf("\n");
}

static void print_table(const struct orl_eval *eval)
{
    printf("%s%s%s, %s\n", eval->method, eval->setting[0] ? " " : "", eval->setting,
           eval->device);
    static const char *const heads[] = {"photograph", "radiance", "vehicle, lamp, wires"};
    _Static_assert(ORL_COUNT(heads) == ORL_FIGURE_GROUPS, "a head for each");
    for (enum orl_figure_group group = 0; group < ORL_FIGURE_GROUPS; group++)
        if (orl_figures_known(group, eval))
            print_rows(eval, heads[group], group);
}

static void print_passes(const struct orl_eval *eval)
{
    printf("%-24s %9s\n", "pass", "ms");
    for (size_t i = 0; i < eval->pass_count; i++)
        printf("%-24s %9.2f\n", eval->passes[i].name, eval->passes[i].ms);
}

static void print_eval(const struct orl_eval *eval, bool first, bool passes)
{
    if (!first)
        printf("\n");
    print_table(eval);
    if (passes)
        print_passes(eval);
    fflush(stdout);
}

static void print_walk_row(const struct orl_stability *s, bool first)
{
    const struct orl_stability_step *all = &s->all;
    char block[64], jump[64];
    if (first)
        printf("walk of %zu frames of %dx%d, %s; differences of one frame, warped, to the next, "
               "in 8-bit values\n%-14s %8s %7s %7s %7s  %7s %22s  %15s %9s\n", s->step_count + 1,
               s->width, s->height, s->device, "method", "seen%", "mean", "floor", "p99",
               "blocks", "worst block", "worst jump", "ms");
    snprintf(block, sizeof block, "%.2f %zu:%d,%d", all->block_worst, s->worst_block_step + 1,
             all->block_x, all->block_y);
    snprintf(jump, sizeof jump, "%.2f %zu", all->jump, s->worst_jump_step + 1);
    printf("%-14s %8.1f %7.3f %7.3f %7.2f  %7.3f %22s  %15s %9.1f\n", s->method,
           100 * all->compared, all->mean, all->floor, all->p99, all->block_mean, block, jump,
           s->render_ms);
    fflush(stdout);
}

// --- the job ---

static enum orl_result start_hdr(struct job *job, const struct orl_render_params *render, struct orl_hdr **hdr)
{
    struct orl_hdr_params params = {ORL_HDR_DEFAULTS};
    params.render = *render;
    params.max_vram_bytes = job->options->max_vram_bytes;
    params.merge = (enum orl_hdr_merge)job->options->merge;
    return orl_hdr_create(job->call->gpu, job->call->scene, &params, hdr);
}

static enum orl_result start_renderer(struct job *job)
{
    const struct orl_renderer_params limits = {
        .max_vram_bytes = job->options->max_vram_bytes, .textures = job->options->textures,
        .photo_divide = job->options->photo_divide, .progress = job->call->progress};
    return orl_renderer_create(job->call->gpu, job->call->scene, &limits, &job->call->renderer);
}

// Measures a method with a renderer of its own, so that it answers for its memory alone.
static enum orl_result evaluate(struct job *job, size_t index)
{
    struct call *call = job->call;
    const struct orl_choice *choice = &job->choices.items[index];
    const struct eval_options *o = job->options;
    struct orl_eval_params params = {.choice = choice, .image_dir = o->images, .pictures = o->pictures,
                                     .views = o->views, .divide = o->divide, .progress = call->progress,
                                     .sequence = o->time_step < 0 && call->scene->frame_count ? call->scene : NULL,
                                     .truth = o->truth ? &job->truth : NULL};
    struct orl_eval eval = {0};
    enum orl_result result = ORL_OK;
    if (o->merge >= 0)
        result = start_hdr(job, &choice->params, &params.hdr);
    else if (!o->pictures)
        result = start_renderer(job);
    ORL_THEN(result, orl_eval_run(call->gpu, call->renderer, call->scene, &params, &eval));
    orl_hdr_destroy(&params.hdr);
    orl_renderer_destroy(&call->renderer);
    ORL_TRY(result);
    if (!report_on_stdout(o->json))
        print_eval(&eval, index == 0, call->common->verbose);
    json_array_append_new(job->reports, orl_eval_report(&eval));
    orl_eval_finish(&eval);
    return ORL_OK;
}

// Measures a method's walk, with the renderer of all.
static enum orl_result walk(struct job *job, size_t index)
{
    struct call *call = job->call;
    const struct eval_options *o = job->options;
    const struct orl_stability_params params = {.choice = &job->choices.items[index], .path = &call->path,
                                                .image_dir = o->images, .progress = call->progress};
    struct orl_stability measured;
    ORL_TRY(orl_stability_run(call->gpu, call->renderer, &params, &measured));
    if (!report_on_stdout(o->json))
        print_walk_row(&measured, index == 0);
    json_array_append_new(job->reports, orl_stability_report(call->scene, &measured));
    orl_stability_finish(&measured);
    return ORL_OK;
}

static enum orl_result measure(struct job *job)
{
    struct call *call = job->call;
    const struct eval_options *o = job->options;
    const size_t count = job->choices.count;
    const bool walks = o->walk || o->path;
    job->reports = json_array();
    enum orl_result result = ORL_OK;
    if (walks)
        result = orl_stability_walk(call->log, call->scene, o->path, (size_t)o->walk, o->divide, &call->path);
    if (result == ORL_OK && walks)
        result = start_renderer(job);
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        result = walks ? walk(job, i) : evaluate(job, i);
    if (result != ORL_OK || !o->json)
        return result;
    bool array = o->vary || o->methods.count > 1 || orl_names_contain(&o->methods, "all") ||
                 orl_names_contain(&o->methods, "paired");
    bool whole = json_array_size(job->reports) == count; // no figure is missing
    return report_write(call->log, o->json,
                        !whole ? NULL : json_incref(array ? job->reports : json_array_get(job->reports, 0)));
}

static enum orl_result check_together(const struct orl_log *log, const struct eval_options *o)
{
    if ((o->walk || o->path) && (o->merge >= 0 || o->truth))
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --walk compares frames with each other: "
                        "without --merge and --truth");
    if ((o->walk && o->path) || ((o->walk || o->path) && o->views))
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --walk, --path and --views exclude each other");
    if ((o->walk || o->path) && o->vary)
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --vary is of held-out photographs: without "
                        "--walk");
    if (o->truth && o->divide > 1)
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --truth is of the photographs' size: without "
                        "--divide");
    if (o->vary && o->images)
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --vary makes several pictures of one name: "
                        "without --images");
    if (o->merge >= 0 && (o->textures != ORL_TEXTURES_AUTO || o->photo_divide > 1))
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --merge keeps photographs as it needs them: "
                        "without --textures and --photo-divide");
    if (o->pictures && (o->methods.count || o->settings.count || o->vary || o->merge >= 0 ||
                        o->truth || o->walk || o->path))
        return orl_fail(log, ORL_ERR_ARGUMENT, "eval: --pictures measures what another program has "
                        "drawn: without --method, --set, --vary, --merge, --truth, --walk and --path");
    return ORL_OK;
}

static enum orl_result choose(struct job *job, const struct orl_scene *scene)
{
    const struct eval_options *o = job->options;
    orl_choices_finish(&job->choices);
    return orl_choices_make(job->call->log, scene,
                            o->merge < 0 ? ORL_SAMPLE_SRGB : ORL_SAMPLE_RADIANCE, &o->methods,
                            &o->settings, o->vary, &job->choices);
}

static enum orl_result evaluate_scene(struct job *job)
{
    struct call *call = job->call;
    const struct eval_options *o = job->options;
    ORL_TRY(check_together(call->log, o));
    if (o->methods.count) // reports wrong settings before the long work
        ORL_TRY(choose(job, NULL));
    ORL_TRY(command_scene(call, NULL));
    if (o->time_step >= 0)
        ORL_TRY(orl_scene_set_frame(call->log, call->scene, o->time_step));
    ORL_TRY(choose(job, call->scene));
    if (!o->walk && !o->path)
        ORL_TRY(orl_eval_check(call->log, call->scene));
    if (o->truth)
        ORL_TRY(orl_truth_open(call->log, call->scene, o->truth, &job->truth));
    ORL_TRY(command_device(call));
    return measure(job);
}

static enum orl_result run_eval(struct call *call)
{
    struct job job = {.call = call, .options = call->options};
    enum orl_result result = evaluate_scene(&job);
    json_decref(job.reports);
    orl_choices_finish(&job.choices);
    orl_truth_finish(&job.truth);
    return result;
}

const struct command command_eval = {
    .name = "eval", .group = COMMAND_MEASURE,
    .brief = "compare renderings with held-out photographs",
    .usage = "SCENE [--method NAME,..|all] [--walk N] [--json FILE] [--images DIR]",
    .summary = "Renders the photographs that were held out and says how close the renderings come.",
    COMMAND_TABLE(eval_options), .inputs_min = 1, .inputs_max = 1, .run = run_eval,
};
