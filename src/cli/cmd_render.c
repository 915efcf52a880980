// oriel render: one view, or every view of a camera path.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/views.h"
#include "core/memory.h"
#include "io/video.h"

struct job {
    const struct orl_log *log;
    const struct orl_progress *progress;
    struct orl_gpu *gpu;
    struct orl_scene *scene;
    struct orl_renderer *renderer;
    struct orl_path path;
    struct orl_render_params params;
    struct orl_frame_output output;
    bool *skip; // per photograph
};

struct options {
    struct view_options views;
    struct output_options output;
    const char *out, *method, *textures;
    struct orl_names settings, exclude;
    int max_vram_mib;
    double fps;
};

static enum orl_result draw_to(struct job *job, size_t view, const char *file)
{
    struct orl_frame frame;
    enum orl_result result = orl_renderer_draw(job->renderer, &job->path.views[view], &job->params,
                                               job->skip, &frame);
    if (result != ORL_OK)
        return result;
    result = orl_frame_write(job->log, file, &job->path.views[view], &frame, &job->output);
    orl_frame_finish(&frame);
    return result;
}

static enum orl_result draw_frames(struct job *job, const char *dir, const char *extension)
{
    enum orl_result result = orl_dir_make(job->log, dir);
    for (size_t i = 0; result == ORL_OK && i < job->path.count; i++) {
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        char *file = orl_format(job->log, "%s/%05zu.%s", dir, i, extension);
        result = file ? draw_to(job, i, file) : ORL_ERR_MEMORY;
        free(file);
        orl_progress_report(job->progress, "render", (double)(i + 1), (double)job->path.count,
                            NULL);
    }
    return result;
}

static enum orl_result draw_video(struct job *job, const char *file, double fps)
{
    char *dir = orl_format(job->log, "%s.frames", file);
    if (!dir)
        return ORL_ERR_MEMORY;
    if (orl_path_is_dir(dir)) {
        free(dir);
        return orl_fail(job->log, ORL_ERR_ARGUMENT,
                        "%s.frames is in the way: frames are kept there meanwhile", file);
    }
    enum orl_result result = draw_frames(job, dir, "png");
    if (result == ORL_OK)
        result = orl_video_encode(job->log, job->progress, dir, fps, file);
    enum orl_result removed = orl_dir_remove(job->log, dir);
    free(dir);
    return result != ORL_OK ? result : removed;
}

static enum orl_result draw_all(const struct options *options, struct job *job)
{
    const char *out = options->out, *extension = strrchr(out, '.');
    bool is_path = options->views.path != NULL;
    if (!is_path)
        return draw_to(job, 0, out);
    if (extension && strcmp(extension, ".mp4") == 0)
        return draw_video(job, out, options->fps);
    if (orl_frame_can_write(out))
        return orl_fail(job->log, ORL_ERR_ARGUMENT,
                        "--out %s: a path needs a folder or an .mp4 file", out);
    const struct orl_frame_layers *layers = &job->output.layers;
    return draw_frames(job, out, layers->depth || layers->normal || layers->coverage ? "exr"
                                                                                    : "png");
}

static enum orl_result run(const struct options *options, const struct arg_common *common,
                           const char *scene_dir, struct job *job)
{
    const struct orl_log *log = job->log;
    if (!options->out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "render: --out FILE|DIR is needed");
    if (!!options->views.at + !!options->views.camera + !!options->views.path != 1)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "render: one of --at PHOTO, --camera FILE, --path FILE is needed");
    if (!options->views.path && !orl_frame_can_write(options->out))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: must end in .png or .exr", options->out);
    struct orl_renderer_params limits = {.max_vram_bytes = (size_t)options->max_vram_mib << 20};
    enum orl_result result = orl_textures_find(log, options->textures, &limits.textures);
    if (result == ORL_OK)
        result = method_choose(log, NULL, options->method, &options->settings,
                               &job->params);
    if (result == ORL_OK)
        result = output_choose(log, &options->output, false, &job->output);
    if (result == ORL_OK)
        result = orl_scene_open(log, scene_dir, &job->scene);
    if (result == ORL_OK)
        result = method_choose(log, job->scene, options->method, &options->settings,
                               &job->params);
    if (result == ORL_OK)
        result = views_choose(log, job->scene, &options->views, &job->path);
    if (result == ORL_OK)
        result = views_exclude(log, job->scene, &options->exclude, &job->skip);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose},
                                &job->gpu);
    if (result == ORL_OK)
        result = orl_renderer_create(job->gpu, job->scene, &limits, &job->renderer);
    return result == ORL_OK ? draw_all(options, job) : result;
}

int cmd_render(int argc, char **argv)
{
    struct options o = {.views = {.frames = 120}, .output = {OUTPUT_OPTIONS_DEFAULTS},
                        .method = "oriel", .textures = "auto", .fps = 30};
    const struct arg_option table[] = {
        {"at", ARG_STRING, &o.views.at, "PHOTO", "from the viewpoint of this photograph", 0, 0},
        {"camera", ARG_STRING, &o.views.camera, "FILE", "from the camera in FILE", 0, 0},
        {"path", ARG_STRING, &o.views.path, "FILE",
         "along the cameras in FILE; \"photos\": past all photographs", 0, 0},
        {"out", ARG_STRING, &o.out, "FILE|DIR",
         ".png or .exr; for a path a folder or .mp4", 0, 0},
        {"size", ARG_SIZE, &o.views.size, "WxH", "picture size; default: the camera's", 0, 0},
        {"method", ARG_STRING, &o.method, "NAME", "oriel (default), airieau or points", 0, 0},
        {"set", ARG_LIST, &o.settings, "KEY=VALUE", "change an option of the method", 0, 0},
        {"exclude", ARG_LIST, &o.exclude, "A,B", "photographs not to use", 0, 0},
        OUTPUT_OPTION_ROWS(&o.output, "also write depth, normal, coverage"),
        {"frames", ARG_INT, &o.views.frames, "N", "of --path photos; default 120", 2, 100000},
        {"fps", ARG_NUMBER, &o.fps, "N", "of .mp4; default 30", 1, 240},
        {"textures", ARG_STRING, &o.textures, "KIND",
         "photographs on the device: auto (default), full, bc7, bc1", 0, 0},
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
