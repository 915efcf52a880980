// oriel hdr: radiance views, panoramas, scenes of radiance photographs.
#include <math.h>
#include <stdlib.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "core/file.h"
#include "core/memory.h"
#include "eval/choice.h"
#include "hdr/replace.h"
#include "oriel/hdr.h"
#include "render/output/sequence.h"

#define HDR_OPTIONS(ROW) \
    VIEW_OPTIONS(ROW) \
    ROW(replace_series, "replace-series", INT(-1, 0, 65535, "N"), \
        "make a scene with the photographs of this series as radiance") \
    ROW(panorama, "panorama", SIZE, "all directions, from --at PHOTO or --position") \
    ROW(position, "position", LIST("X,Y,Z"), "of the panorama, in the scene's units") \
    ROW(up, "up", LIST("X,Y,Z"), \
        "of the panorama; default: the photographs' mean upward direction") \
    ROW(out, "out", NEEDED("FILE|DIR"), ".exr or .png; for a path a folder or .mp4; for a scene a folder") \
    ROW(samples, "samples", INT(1, 1, 4, "N"), "N x N samples a pixel") \
    ROW(merge, "merge", CHOICE(orl_hdr_merge, ORL_HDR_MERGES, ORL_HDR_FUSED, "NAME"), \
        "one gather in radiance, or a picture of each series, merged") \
    METHOD_OPTIONS(ROW) \
    ROW(exclude, "exclude", LIST("A,B"), "photographs not to use") \
    LIGHT_OPTION(ROW) \
    OUTPUT_OPTIONS(ROW, "depth, normal, coverage, confidence; default: all in .exr") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
COMMAND_OPTIONS(hdr_options, HDR_OPTIONS)

struct job {
    struct call *call;
    struct orl_hdr *hdr;
    struct orl_frame_output output;
    const char *method; // name
};

static enum orl_result draw(void *priv, const struct orl_view *view, struct orl_frame *frame)
{
    const struct job *job = priv;
    return orl_hdr_draw(job->hdr, view, job->call->skip, frame);
}

// --- panorama ---

static enum orl_result parse_vector(const struct orl_log *log, const char *option,
                                    const struct orl_names *names, double v[3])
{
    for (size_t i = 0; i < 3; i++) {
        char *end = NULL;
        v[i] = i < names->count ? strtod(names->items[i], &end) : NAN;
        if (names->count != 3 || end == names->items[i] || *end || !isfinite(v[i]))
            return orl_fail(log, ORL_ERR_ARGUMENT, "--%s: must be three numbers: X,Y,Z", option);
    }
    return ORL_OK;
}

static enum orl_result draw_panorama(struct job *job)
{
    const struct call *call = job->call;
    const struct hdr_options *o = call->options;
    struct orl_panorama p = {.width = o->panorama.width, .height = o->panorama.height};
    struct orl_frame frame;
    struct orl_view view;
    ORL_TRY(orl_panorama_place(call->log, call->scene, o->at, &p));
    if (!o->at)
        ORL_TRY(parse_vector(call->log, "position", &o->position, p.position));
    if (o->up.count)
        ORL_TRY(parse_vector(call->log, "up", &o->up, p.up));
    ORL_TRY(orl_hdr_draw_panorama(job->hdr, &p, call->skip, &frame));
    job->output.attributes.latlong = orl_panorama_view(&p, &view);
    enum orl_result result = orl_frame_write(call->log, o->out, &view, &frame, &job->output);
    orl_frame_finish(&frame);
    return result;
}

// --- a series ---

static enum orl_result replace_series(const struct job *job)
{
    const struct hdr_options *o = job->call->options;
    const struct orl_replace_params params = {.series = o->replace_series, .out = o->out,
                                              .skip = job->call->skip, .tone = job->output.tone,
                                              .method = job->method};
    return orl_hdr_replace_series(job->hdr, &params, job->call->progress);
}

// --- the command ---

static enum orl_result check(const struct hdr_options *o, const struct orl_log *log)
{
    bool panorama = o->panorama.width, replace = o->replace_series >= 0;
    int views = !!o->at + !!o->camera + !!o->path + replace;
    if (panorama && (!!o->at + !!o->position.count != 1 || o->camera ||
                     o->path || replace))
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "hdr: --panorama needs --at PHOTO or --position X,Y,Z, and no other view");
    if (!panorama && views != 1)
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: one of --at PHOTO, --camera FILE, "
                        "--path FILE, --replace-series N, --panorama WxH is needed");
    if (!panorama && (o->position.count || o->up.count))
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: --position and --up are of --panorama");
    if (panorama && o->size.width)
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: --panorama has its own size");
    if (replace && (o->size.width || o->layers.count || o->light))
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: --replace-series makes photographs: without "
                        "--size, --layers and --light");
    bool file = orl_frame_can_write(o->out);
    if (o->path)
        return orl_sequence_check_out(log, o->out, false, o->layers.count);
    if (replace && file)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: a scene needs a folder", o->out);
    if (!replace && !file)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: must end in .exr or .png", o->out);
    return ORL_OK;
}

// By default all layers; a format for viewing has colour only.
static void default_layers(const struct hdr_options *o, struct orl_frame_layers *layers)
{
    if (!o->layers.count && !orl_path_has_extension(o->out, "png mp4"))
        *layers = (struct orl_frame_layers){true, true, true, true};
}

// Opens all that pictures are made of.
static enum orl_result open_all(struct job *job)
{
    struct call *call = job->call;
    const struct hdr_options *o = call->options;
    struct orl_hdr_params params = {ORL_HDR_DEFAULTS};
    struct orl_choice choice = {0};
    ORL_TRY(check(o, call->log));
    if (o->method) // reports wrong settings before the long work
        ORL_TRY(orl_choice_make(call->log, NULL, ORL_SAMPLE_RADIANCE, o->method, &o->settings, &choice));
    ORL_TRY(output_choose(call->log, OUTPUT_OPTIONS_COPY, true, &job->output));
    default_layers(o, &job->output.layers);
    ORL_TRY(command_scene(call, o->light));
    ORL_TRY(orl_choice_make(call->log, call->scene, ORL_SAMPLE_RADIANCE, o->method, &o->settings, &choice));
    if (!o->panorama.width && o->replace_series < 0)
        ORL_TRY(orl_views_choose(call->log, call->scene, &VIEW_OPTIONS_COPY, &call->path));
    ORL_TRY(orl_photos_named(call->log, call->scene, &o->exclude, &call->skip));
    ORL_TRY(command_device(call));
    job->method = choice.method->name;
    params.merge = o->merge;
    params.render = choice.params;
    params.samples = o->samples;
    params.max_vram_bytes = o->max_vram_bytes;
    return orl_hdr_create(call->gpu, call->scene, &params, &job->hdr);
}

static enum orl_result draw_all(struct job *job)
{
    const struct call *call = job->call;
    const struct hdr_options *o = call->options;
    if (o->panorama.width)
        return draw_panorama(job);
    if (o->replace_series >= 0)
        return replace_series(job);
    const struct orl_sequence all = {.views = call->path.views, .count = call->path.count,
                                     .draw = draw, .priv = job, .output = &job->output,
                                     .step = "hdr", .progress = call->progress};
    return o->path ? orl_sequence_write(call->log, &all, o->out, "exr", o->fps)
                   : orl_sequence_write_view(call->log, &all, &call->path.views[0], o->out);
}

static enum orl_result run_hdr(struct call *call)
{
    struct job job = {.call = call, .output = {ORL_FRAME_OUTPUT_DEFAULTS}};
    enum orl_result result = open_all(&job);
    ORL_THEN(result, draw_all(&job));
    orl_hdr_destroy(&job.hdr);
    return result;
}

const struct command command_hdr = {
    .name = "hdr", .group = COMMAND_LOOK,
    .brief = "radiance views from photographs of several exposures",
    .usage = "SCENE (--at PHOTO | --camera FILE | --path FILE | --replace-series N |\n"
             "                  --panorama WxH) --out FILE|DIR [options]",
    .summary = "Radiance views: photographs of several exposures, merged.",
    COMMAND_TABLE(hdr_options), .inputs_min = 1, .inputs_max = 1, .run = run_hdr,
};
