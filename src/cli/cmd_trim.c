// oriel trim: the least model of a scene that still serves.
#include <stdio.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "eval/trim.h"

#define TRIM_OPTIONS(ROW) \
    ORL_TRIM_OPTIONS(ROW) \
    METHOD_OPTIONS(ROW) \
    ROW(json, "json", TEXT("FILE"), "write figures and steps as JSON; - for stdout")
COMMAND_OPTIONS(trim_options, TRIM_OPTIONS)

enum { MIB = 1 << 20 };

// --- what is printed ---

static void print_step(void *priv, const struct orl_trim_step *s)
{
    (void)priv;
    printf("%-36s %8.3f %8.3f %9.2f %9.1f\n", s->what, s->loss_db, s->total_loss_db,
           s->bytes / MIB, s->ms);
    fflush(stdout);
}

static void print_row(const char *name, const struct orl_trim_figures *f)
{
    printf("%-10s %9zu %6zu %9.2f %9.2f %9.2f %9.1f %8.2f %7.4f %8.2f %7.4f\n", name, f->points,
           f->photographs, (double)(f->point_bytes + f->photo_bytes) / MIB,
           (double)f->device_bytes / MIB, (double)f->file_bytes / MIB, f->frame_ms, f->psnr_db,
           f->ssim, f->held_psnr_db, f->held_ssim);
}

static void print_summary(const struct trim_options *o, const struct orl_trim *trim)
{
    const struct orl_trim_figures *a = &trim->before, *b = &trim->after;
    printf("\n%-10s %9s %6s %9s %9s %9s %9s %8s %7s %8s %7s\n", "", "points", "photos",
           "model MiB", "all MiB", "file MiB", "frame ms", "PSNR dB", "SSIM", "held out", "SSIM");
    print_row("whole", a);
    print_row("trimmed", b);
    printf("%s: %.1f times smaller on the device; training photographs lost %.3f dB, the worst of "
           "them %.3f%s\n", o->out,
           (double)(a->point_bytes + a->photo_bytes) / (double)(b->point_bytes + b->photo_bytes),
           a->psnr_db - b->psnr_db, b->worst_loss_db,
           trim->complete ? "" : "; the budget ended the search");
    if (trim->undone)
        printf("%zu steps were taken back, because all photographs together lost too much\n",
               trim->undone);
}

// --- the job ---

static enum orl_result run_trim(struct call *call)
{
    const struct trim_options *o = call->options;
    struct orl_choice start;
    struct orl_trim trim = {0};
    enum orl_result result = command_scene(call, NULL);
    ORL_THEN(result, orl_choice_make(call->log, call->scene, ORL_SAMPLE_SRGB, o->method, &o->settings, &start));
    const bool silent = report_on_stdout(o->json), steps = !call->common->quiet && !silent;
    start.params.soft = 0; // soft splats have seen the photographs that decide
    ORL_THEN(result, command_device(call));
    const struct orl_trim_params params = {ORL_TRIM_OPTIONS(ORL_OPTION_COPY) .start = &start,
                                           .on_step = steps ? print_step : NULL,
                                           .progress = call->progress};
    if (result == ORL_OK && steps)
        printf("%-36s %8s %8s %9s %9s\n", "step", "loss dB", "all dB", "MiB", "frame ms");
    ORL_THEN(result, orl_trim_run(call->gpu, call->scene, &params, &trim));
    if (result == ORL_OK && !silent)
        print_summary(o, &trim);
    if (result == ORL_OK && o->json)
        result = report_write(call->log, o->json,
                              orl_trim_report(call->scene, orl_gpu_caps(call->gpu)->renderer, &trim));
    orl_trim_finish(&trim);
    return result;
}

const struct command command_trim = {
    .name = "trim", .group = COMMAND_FIT,
    .brief = "make the least scene that serves as well",
    .usage = "SCENE --out SCENE2 [--tolerance DB]",
    .summary = "Makes the least scene that serves as well: fewer points and photographs, smaller files,\n"
               "and the method's cheaper options. Training photographs decide, each rendered from the\n"
               "others; held-out ones confirm at the end.",
    COMMAND_TABLE(trim_options), .inputs_min = 1, .inputs_max = 1, .run = run_trim,
};
