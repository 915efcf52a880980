// oriel hdr: radiance views, panoramas, scenes of radiance photographs.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/command_output.h"
#include "core/memory.h"
#include "eval/choice.h"
#include "hdr/replace.h"
#include "oriel/hdr.h"
#include "render/sequence.h"
#include "scene/light.h"
#include "scene/view_choice.h"

struct options {
    struct orl_view_choice views;
    struct arg_size size;
    struct output_options output;
    const char *out, *method, *light;
    struct arg_enum merge;
    struct orl_names settings, exclude, position, up;
    struct arg_size panorama;
    int replace_series, samples, max_vram_mib;
    bool half;
};

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

static bool has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && strcmp(dot, extension) == 0;
}

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

static enum orl_result draw_panorama(const struct options *options, struct job *job)
{
    struct orl_panorama p = {.width = options->panorama.width, .height = options->panorama.height};
    struct orl_frame frame;
    struct orl_view view;
    enum orl_result result = orl_panorama_place(job->log, job->scene, options->views.at, &p);
    if (result == ORL_OK && !options->views.at)
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

static enum orl_result replace_series(const struct options *o, struct job *job)
{
    const struct orl_replace_params params = {.series = o->replace_series, .out = o->out,
                                              .skip = job->skip, .tone = job->output.tone,
                                              .method = job->method};
    return orl_hdr_replace_series(job->hdr, &params, job->progress);
}

// --- the command ---

static enum orl_result check(const struct options *o, const struct orl_log *log)
{
    bool panorama = o->panorama.width, replace = o->replace_series >= 0;
    int views = !!o->views.at + !!o->views.camera + !!o->views.path + replace;
    if (!o->out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: --out FILE|DIR is needed");
    if (panorama && (!!o->views.at + !!o->position.count != 1 || o->views.camera ||
                     o->views.path || replace))
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "hdr: --panorama needs --at PHOTO or --position X,Y,Z, and no other view");
    if (!panorama && views != 1)
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: one of --at PHOTO, --camera FILE, "
                        "--path FILE, --replace-series N, --panorama WxH is needed");
    if (!panorama && (o->position.count || o->up.count))
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: --position and --up are of --panorama");
    if (panorama && o->size.width)
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: --panorama has its own size");
    if (replace && (o->size.width || o->output.layers.count || o->light))
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: --replace-series makes photographs: without "
                        "--size, --layers and --light");
    if (o->half && o->output.float_color)
        return orl_fail(log, ORL_ERR_ARGUMENT, "hdr: --half and --float exclude each other");
    bool many = o->views.path || replace, file = orl_frame_can_write(o->out);
    if (many && file)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: several views need a folder", o->out);
    if (!many && !file)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: must end in .exr or .png", o->out);
    return ORL_OK;
}

// By default all layers; a picture format for viewing has colour only.
static void default_layers(const struct options *o, struct orl_frame_layers *layers)
{
    if (!o->output.layers.count && !has_extension(o->out, ".png"))
        *layers = (struct orl_frame_layers){true, true, true, true};
}

static enum orl_result run(const struct options *o, const struct arg_common *common,
                           const char *scene_dir, struct job *job)
{
    const struct orl_log *log = job->log;
    enum orl_result result = check(o, log);
    struct orl_choice choice = {0};
    struct orl_view_choice views = o->views;
    views.width = o->size.width;
    views.height = o->size.height;
    if (result == ORL_OK && o->method) // reports wrong settings before the long work
        result = orl_choice_make(log, NULL, ORL_SAMPLE_RADIANCE, o->method, &o->settings, &choice);
    if (result == ORL_OK)
        result = output_choose(log, &o->output, true, &job->output);
    if (result == ORL_OK)
        default_layers(o, &job->output.layers);
    job->params.merge = (enum orl_hdr_merge)o->merge.value;
    job->params.samples = o->samples;
    job->params.max_vram_bytes = (size_t)o->max_vram_mib << 20;
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
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose},
                                &job->gpu);
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
    return o->views.path ? orl_sequence_write_dir(log, &all, o->out, "exr")
                         : orl_sequence_write_view(log, &all, &job->path.views[0], o->out);
}

static void finish(struct options *o, struct job *job)
{
    orl_hdr_destroy(&job->hdr);
    orl_gpu_destroy(&job->gpu);
    orl_scene_destroy(&job->scene);
    orl_path_finish(&job->path);
    free(job->skip);
    orl_names_finish(&o->settings);
    orl_names_finish(&o->exclude);
    orl_names_finish(&o->position);
    orl_names_finish(&o->up);
    orl_names_finish(&o->output.layers);
}

int cmd_hdr(int argc, char **argv)
{
    struct options o = {.views = {.frames = 120},
                        .merge = {orl_hdr_merge_names, ORL_HDR_FUSED},
                        .replace_series = -1, .samples = 1};
    output_options_init(&o.output);
    const struct arg_option table[] = {
        {"at", ARG_STRING, &o.views.at, "PHOTO", "from the viewpoint of this photograph", 0, 0},
        {"camera", ARG_STRING, &o.views.camera, "FILE", "from the camera in FILE", 0, 0},
        {"path", ARG_STRING, &o.views.path, "FILE",
         "along the cameras in FILE; \"photos\": past all photographs; \"circle\": around what they "
         "look at", 0, 0},
        {"replace-series", ARG_INT, &o.replace_series, "N",
         "make a scene with the photographs of this series as radiance", 0, 65535},
        {"panorama", ARG_SIZE, &o.panorama, "WxH",
         "all directions, from --at PHOTO or --position", 0, 0},
        {"position", ARG_LIST, &o.position, "X,Y,Z", "of the panorama, in the scene's units", 0, 0},
        {"up", ARG_LIST, &o.up, "X,Y,Z",
         "of the panorama; default: the photographs' mean upward direction", 0, 0},
        {"out", ARG_STRING, &o.out, "FILE|DIR",
         ".exr or .png; for several views or a scene a folder", 0, 0},
        {"size", ARG_SIZE, &o.size, "WxH", "picture size; default: the camera's", 0, 0},
        {"samples", ARG_INT, &o.samples, "N", "N x N samples a pixel, from 1 to 4; default 1", 1,
         4},
        {"merge", ARG_ENUM, &o.merge, "NAME",
         "one gather in radiance, or a picture of each series, merged", 0, 0},
        {"method", ARG_STRING, &o.method, "NAME",
         "of rendering; default: the scene's, or else the first of oriel methods", 0, 0},
        {"set", ARG_LIST, &o.settings, "KEY=VALUE", "change an option of the method", 0, 0},
        {"exclude", ARG_LIST, &o.exclude, "A,B", "photographs not to use", 0, 0},
        LIGHT_OPTION_ROW(&o.light),
        OUTPUT_OPTION_ROWS(&o.output, "depth, normal, coverage, confidence; default: all in .exr"),
        {"half", ARG_FLAG, &o.half, NULL, "of .exr: 16-bit colour, the default", 0, 0},
        {"frames", ARG_INT, &o.views.frames, "N", "of --path photos and circle; default 120", 2, 100000},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory to plan for", 1, 1 << 20},
        {0},
    };
    const struct arg_command command = {
        "hdr", "SCENE (--at PHOTO | --camera FILE | --path FILE | --replace-series N |\n"
        "                  --panorama WxH) --out FILE|DIR [options]",
        "Radiance views: photographs of several exposures, merged.", table, 1, 1};
    struct arg_common common = {0};
    struct terminal terminal;
    const char *scene_dir;
    size_t count;
    int status;
    struct job job = {.params = {ORL_HDR_DEFAULTS}, .output = {ORL_FRAME_OUTPUT_DEFAULTS}};
    if (command_begin(&command, argc, argv, &common, &terminal, &scene_dir, &count, &status)) {
        job.log = &terminal.log;
        job.progress = &terminal.progress;
        status = command_status(run(&o, &common, scene_dir, &job));
        terminal_finish(&terminal);
    }
    finish(&o, &job);
    return status;
}
