// oriel render: renders one view, or every view of a camera path.
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/command_output.h"
#include "eval/choice.h"
#include "render/sequence.h"
#include "scene/light.h"
#include "scene/view_choice.h"

struct job {
    const struct orl_log *log;
    const struct orl_progress *progress;
    struct orl_gpu *gpu;
    struct orl_scene *scene;
    struct orl_renderer *renderer;
    struct orl_path path;
    struct orl_choice choice;
    struct orl_frame_output output;
    bool *skip;     // per photograph
    bool time_runs; // the path leads through the moments of a sequence
    size_t end;     // pictures of the path before this one are drawn
};

struct options {
    struct orl_view_choice views;
    struct arg_size size;
    struct output_options output;
    const char *out, *method, *part, *light;
    struct arg_enum textures, radiance;
    struct orl_names settings, exclude;
    int max_vram_mib, moment; // moment of a sequence; -1: all of them along a path
    double fps;
};

// Of the picture of a path, when time runs.
static int moment_of(const struct job *job, size_t picture)
{
    return (int)(picture * job->scene->frame_count / job->path.count);
}

static enum orl_result draw(void *priv, const struct orl_view *view, struct orl_frame *frame)
{
    struct job *job = priv;
    size_t picture = (size_t)(view - job->path.views); // sequences draw the views of the path
    enum orl_result result = ORL_OK;
    if (job->time_runs) {
        result = orl_scene_set_frame(job->log, job->scene, moment_of(job, picture));
        if (picture + 1 < job->end)
            orl_renderer_expect(job->renderer, moment_of(job, picture + 1));
    }
    if (result != ORL_OK)
        return result;
    return orl_renderer_draw(job->renderer, view, &job->choice.params, job->skip, frame);
}

static bool is_video(const char *out)
{
    const char *extension = strrchr(out, '.');
    return extension && strcmp(extension, ".mp4") == 0;
}

static enum orl_result draw_all(const struct options *options, struct job *job)
{
    const char *out = options->out;
    int index = 0, parts = 1;
    enum orl_result result =
        options->part ? args_part(job->log, options->part, &index, &parts) : ORL_OK;
    if (result != ORL_OK)
        return result;
    job->end = job->path.count * ((size_t)index + 1) / (size_t)parts;
    const struct orl_sequence sequence = {
        .views = job->path.views, .first = job->path.count * (size_t)index / (size_t)parts,
        .count = job->end, .draw = draw, .priv = job,
        .output = &job->output, .step = "render", .progress = job->progress};
    if (!options->views.path)
        return orl_sequence_write_view(job->log, &sequence, &job->path.views[0], out);
    if (is_video(out))
        return orl_sequence_write_video(job->log, &sequence, out, options->fps);
    if (orl_frame_can_write(out))
        return orl_fail(job->log, ORL_ERR_ARGUMENT,
                        "--out %s: a path needs a folder or an .mp4 file", out);
    const struct orl_frame_layers *layers = &job->output.layers;
    bool exr = layers->depth || layers->normal || layers->coverage;
    return orl_sequence_write_dir(job->log, &sequence, out, exr ? "exr" : "png");
}

static enum orl_result check(const struct orl_log *log, const struct options *options)
{
    if (!options->out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "render: --out FILE|DIR is needed");
    if (!!options->views.at + !!options->views.camera + !!options->views.path != 1)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "render: one of --at PHOTO, --camera FILE, --path FILE is needed");
    if (options->part && (!options->views.path || is_video(options->out)))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--part: only the frames of a path in a folder have "
                        "parts");
    if (!options->views.path && !orl_frame_can_write(options->out))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: must end in .png or .exr", options->out);
    return options->method && !orl_method_find(log, options->method) ? ORL_ERR_ARGUMENT : ORL_OK;
}

static enum orl_result run(const struct options *options, const struct arg_common *common,
                           const char *scene_dir, struct job *job)
{
    const struct orl_log *log = job->log;
    struct orl_view_choice views = options->views;
    views.width = options->size.width;
    views.height = options->size.height;
    struct orl_renderer_params limits = {
        .max_vram_bytes = (size_t)options->max_vram_mib << 20,
        .textures = (enum orl_textures)options->textures.value,
        .progress = job->progress};
    enum orl_result result = check(log, options);
    if (result == ORL_OK)
        result = output_choose(log, &options->output, false, &job->output);
    if (result == ORL_OK)
        result = orl_scene_open(log, scene_dir, &job->scene);
    if (result == ORL_OK)
        result = orl_scene_set_light(log, job->scene, options->light);
    if (result == ORL_OK && options->moment >= 0)
        result = orl_scene_set_frame(log, job->scene, options->moment);
    if (result == ORL_OK)
        limits.radiance = radiance_chosen(log, job->scene, &options->radiance);
    if (result == ORL_OK)
        result = orl_choice_make(log, job->scene,
                                 limits.radiance ? ORL_SAMPLE_RADIANCE : ORL_SAMPLE_SRGB,
                                 options->method, &options->settings, &job->choice);
    if (result == ORL_OK)
        result = orl_views_choose(log, job->scene, &views, &job->path);
    if (result == ORL_OK)
        result = orl_photos_named(log, job->scene, &options->exclude, &job->skip);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose},
                                &job->gpu);
    if (result == ORL_OK)
        result = orl_renderer_create(job->gpu, job->scene, &limits, &job->renderer);
    job->time_runs = options->views.path && options->moment < 0 && job->scene &&
                     job->scene->frame_count > 0;
    return result == ORL_OK ? draw_all(options, job) : result;
}

int cmd_render(int argc, char **argv)
{
    struct options o = {.views = {.frames = 120}, 
                        .textures = {orl_textures_names, ORL_TEXTURES_AUTO},
                        .radiance = {radiance_names, RADIANCE_AUTO}, .fps = 30,
                        .moment = -1};
    output_options_init(&o.output);
    const struct arg_option table[] = {
        {"at", ARG_STRING, &o.views.at, "PHOTO", "from the viewpoint of this photograph", 0, 0},
        {"camera", ARG_STRING, &o.views.camera, "FILE", "from the camera in FILE", 0, 0},
        {"path", ARG_STRING, &o.views.path, "FILE",
         "along the cameras in FILE; \"photos\": past all photographs; \"circle\": around what they "
         "look at", 0, 0},
        {"frame", ARG_INT, &o.moment, "N",
         "moment of a sequence, from 0; default: along a path all, else the first", 0, 1 << 20},
        {"out", ARG_STRING, &o.out, "FILE|DIR",
         ".png or .exr; for a path a folder or .mp4", 0, 0},
        {"size", ARG_SIZE, &o.size, "WxH", "picture size; default: the camera's", 0, 0},
        {"method", ARG_STRING, &o.method, "NAME",
         "default: the scene's, or else the first of oriel methods", 0, 0},
        {"set", ARG_LIST, &o.settings, "KEY=VALUE", "change an option of the method", 0, 0},
        {"exclude", ARG_LIST, &o.exclude, "A,B", "photographs not to use", 0, 0},
        LIGHT_OPTION_ROW(&o.light),
        RADIANCE_OPTION_ROW(&o.radiance),
        OUTPUT_OPTION_ROWS(&o.output, "also write depth, normal, coverage"),
        {"part", ARG_STRING, &o.part, "K/N", "only the K-th of N parts of the frames of a path",
         0, 0},
        {"frames", ARG_INT, &o.views.frames, "N", "of --path photos and circle; default 120", 2, 100000},
        {"fps", ARG_NUMBER, &o.fps, "N", "of .mp4; default 30", 1, 240},
        {"textures", ARG_ENUM, &o.textures, "KIND", "photographs on the device", 0, 0},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory to plan for", 1, 1 << 20},
        {0},
    };
    const struct arg_command command = {
        "render", "SCENE (--at PHOTO | --camera FILE | --path FILE) --out FILE|DIR [options]",
        "Renders views that nobody photographed.", table, 1, 1};
    struct arg_common common = {0};
    struct terminal terminal;
    const char *scene_dir;
    size_t count;
    int status;
    if (command_begin(&command, argc, argv, &common, &terminal, &scene_dir, &count, &status)) {
        struct job job = {.log = &terminal.log, .progress = &terminal.progress,
                          .output = {ORL_FRAME_OUTPUT_DEFAULTS}};
        status = command_status(run(&o, &common, scene_dir, &job));
        orl_renderer_destroy(&job.renderer);
        orl_gpu_destroy(&job.gpu);
        orl_scene_destroy(&job.scene);
        orl_path_finish(&job.path);
        free(job.skip);
        terminal_finish(&terminal);
    }
    orl_names_finish(&o.settings);
    orl_names_finish(&o.exclude);
    orl_names_finish(&o.output.layers);
    return status;
}
