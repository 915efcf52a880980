// oriel hdr: radiance views, panoramas, scenes of radiance photographs.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "core/file.h"
#include "core/memory.h"
#include "eval/choice.h"
#include "hdr/replace.h"
#include "oriel/hdr.h"
#include "render/sequence.h"
#include "scene/light.h"
#include "scene/view_choice.h"

#define HDR_OPTIONS(ROW) \
    VIEW_OPTIONS(ROW) \
    ROW(replace_series, "replace-series", INT(-1, 0, 65535, "N"), \
        "make a scene with the photographs of this series as radiance") \
    ROW(panorama, "panorama", SIZE, "all directions, from --at PHOTO or --position") \
    ROW(position, "position", LIST("X,Y,Z"), "of the panorama, in the scene's units") \
    ROW(up, "up", LIST("X,Y,Z"), \
        "of the panorama; default: the photographs' mean upward direction") \
    ROW(out, "out", NEEDED("FILE|DIR"), ".exr or .png; for several views or a scene a folder") \
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
    const struct orl_log *log;
    const struct orl_progress *progress;
    struct orl_gpu *gpu;
    struct orl_scene *scene;
    struct orl_hdr *hdr;
    struct orl_path path;
    struct orl_hdr_params params;
    struct orl_frame_output output;
    const char *method; // name
    bool *skip;         // per photograph
};

// --- output ---

static enum orl_result draw(void *priv, const struct orl_view *view, struct orl_frame *frame)
{
    struct job *job = priv;
    return orl_hdr_draw(job->hdr, view, job->skip, frame);
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

static enum orl_result draw_panorama(const struct hdr_options *options, struct job *job)
{
    struct orl_panorama p = {.width = options->panorama.width, .height = options->panorama.height};
    struct orl_frame frame;
    struct orl_view view;
    enum orl_result result = orl_panorama_place(job->log, job->scene, options->at, &p);
    if (result == ORL_OK && !options->at)
        result = parse_vector(job->log, "position", &options->position, p.position);
    if (result == ORL_OK && options->up.count)
        result = parse_vector(job->log, "up", &options->up, p.up);
    if (result == ORL_OK)
        result = orl_hdr_draw_panorama(job->hdr, &p, job->skip, &frame);
    if (result != ORL_OK)
        return result;
    job->output.attributes.latlong = orl_panorama_view(&p, &view);
    result = orl_frame_write(job->log, options->out, &view, &frame, &job->output);
    orl_frame_finish(&frame);
    return result;
}

// --- a series ---

static enum orl_result replace_series(const struct hdr_options *o, struct job *job)
{
    const struct orl_replace_params params = {.series = o->replace_series, .out = o->out,
                                              .skip = job->skip, .tone = job->output.tone,
                                              .method = job->method};
    return orl_hdr_replace_series(job->hdr, &params, job->progress);
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
    bool many = o->path || replace, file = orl_frame_can_write(o->out);
    if (many && file)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: several views need a folder", o->out);
    if (!many && !file)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: must end in .exr or .png", o->out);
    return ORL_OK;
}

// By default all layers; a picture format for viewing has colour only.
static void default_layers(const struct hdr_options *o, struct orl_frame_layers *layers)
{
    if (!o->layers.count && !orl_path_has_extension(o->out, "png"))
        *layers = (struct orl_frame_layers){true, true, true, true};
}

static enum orl_result hdr_scene(const struct hdr_options *o, const struct common_options *common,
                                 const char *scene_dir, struct job *job)
{
    const struct orl_log *log = job->log;
    enum orl_result result = check(o, log);
    struct orl_choice choice = {0};
    const struct orl_view_choice views = {o->at, o->camera, o->path, o->frames, o->size.width,
                                          o->size.height};
    if (result == ORL_OK && o->method) // reports wrong settings before the long work
        result = orl_choice_make(log, NULL, ORL_SAMPLE_RADIANCE, o->method, &o->settings, &choice);
    if (result == ORL_OK)
        result = output_choose(log, OUTPUT_OPTIONS_COPY, true, &job->output);
    if (result == ORL_OK)
        default_layers(o, &job->output.layers);
    job->params.merge = o->merge;
    job->params.samples = o->samples;
    job->params.max_vram_bytes = o->max_vram_bytes;
    if (result == ORL_OK)
        result = orl_scene_open(log, scene_dir, &job->scene);
    if (result == ORL_OK)
        result = orl_scene_set_light(log, job->scene, o->light);
    if (result == ORL_OK)
        result = orl_choice_make(log, job->scene, ORL_SAMPLE_RADIANCE, o->method, &o->settings,
                                 &choice);
    if (result == ORL_OK)
        job->method = choice.method->name;
    job->params.render = choice.params;
    if (result == ORL_OK && !o->panorama.width && o->replace_series < 0)
        result = orl_views_choose(log, job->scene, &views, &job->path);
    if (result == ORL_OK)
        result = orl_photos_named(log, job->scene, &o->exclude, &job->skip);
    if (result == ORL_OK)
        result = command_device(log, common, &job->gpu);
    if (result == ORL_OK)
        result = orl_hdr_create(job->gpu, job->scene, &job->params, &job->hdr);
    if (result != ORL_OK)
        return result;
    if (o->panorama.width)
        return draw_panorama(o, job);
    if (o->replace_series >= 0)
        return replace_series(o, job);
    const struct orl_sequence all = {.views = job->path.views, .count = job->path.count,
                                     .draw = draw, .priv = job, .output = &job->output,
                                     .step = "hdr", .progress = job->progress};
    return o->path ? orl_sequence_write_dir(log, &all, o->out, "exr")
                         : orl_sequence_write_view(log, &all, &job->path.views[0], o->out);
}

static enum orl_result run_hdr(struct terminal *terminal, const void *options,
                               const struct common_options *common, const char *const *inputs)
{
    struct job job = {.log = &terminal->log, .progress = &terminal->progress,
                      .params = {ORL_HDR_DEFAULTS}, .output = {ORL_FRAME_OUTPUT_DEFAULTS}};
    enum orl_result result = hdr_scene(options, common, inputs[0], &job);
    orl_hdr_destroy(&job.hdr);
    orl_gpu_destroy(&job.gpu);
    orl_scene_destroy(&job.scene);
    orl_path_finish(&job.path);
    free(job.skip);
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
