// oriel render: one view, or every view of a camera path.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "core/memory.h"
#include "io/video.h"
#include "render/output.h"
#include "scene/path.h"

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
    const char *at, *camera, *path, *out, *method, *tone, *compression;
    struct orl_names settings, exclude, layers;
    struct arg_size size;
    int frames, max_vram_mib;
    double fps, exposure_ev, white;
    bool float_color;
};

static enum orl_result choose_layers(const struct orl_log *log, const struct orl_names *names,
                                     struct orl_frame_layers *layers)
{
    for (size_t i = 0; i < names->count; i++) {
        const char *name = names->items[i];
        if (strcmp(name, "depth") == 0)
            layers->depth = true;
        else if (strcmp(name, "normal") == 0)
            layers->normal = true;
        else if (strcmp(name, "coverage") == 0)
            layers->coverage = true;
        else
            return orl_fail(log, ORL_ERR_ARGUMENT, "--layers %s: must be of depth, normal, coverage",
                            name);
    }
    return ORL_OK;
}

static enum orl_result choose_output(const struct options *options, struct job *job)
{
    struct orl_frame_output *output = &job->output;
    output->float_color = options->float_color;
    output->tone.exposure_ev = options->exposure_ev;
    output->tone.white = options->white;
    if (strcmp(options->compression, "piz") == 0)
        output->compression = ORL_EXR_PIZ;
    else if (strcmp(options->compression, "zip") != 0)
        return orl_fail(job->log, ORL_ERR_ARGUMENT, "--compression %s: must be zip or piz",
                        options->compression);
    return orl_tone_find(job->log, options->tone, &output->tone.curve);
}

static enum orl_result choose_method(const struct options *options, struct job *job)
{
    const struct orl_method *method = orl_method_find(job->log, options->method);
    if (!method)
        return ORL_ERR_ARGUMENT;
    job->params = method->params;
    enum orl_result result = choose_layers(job->log, &options->layers, &job->output.layers);
    if (result == ORL_OK)
        result = choose_output(options, job);
    for (size_t i = 0; result == ORL_OK && i < options->settings.count; i++)
        result = orl_render_params_set(job->log, &job->params, options->settings.items[i]);
    return result;
}

static enum orl_result single_view(struct job *job, const struct orl_view *view)
{
    job->path.views = orl_array(job->log, 1, sizeof *job->path.views);
    if (!job->path.views)
        return ORL_ERR_MEMORY;
    job->path.views[0] = *view;
    job->path.count = 1;
    return ORL_OK;
}

static enum orl_result choose_views(const struct options *options, struct job *job)
{
    enum orl_result result;
    if (options->at) {
        int index = orl_scene_find_photo(job->scene, options->at);
        if (index < 0)
            return orl_fail(job->log, ORL_ERR_NOT_FOUND, "%s has no photograph %s",
                            job->scene->dir, options->at);
        result = single_view(job, &job->scene->photos[index].view);
    } else if (options->path && strcmp(options->path, "photos") == 0) {
        result = orl_path_through_photos(job->log, job->scene, (size_t)options->frames,
                                         &job->path);
    } else {
        const char *file = options->camera ? options->camera : options->path;
        result = orl_path_read(job->log, job->scene, file, &job->path);
        if (result == ORL_OK && options->camera && job->path.count != 1)
            result = orl_fail(job->log, ORL_ERR_ARGUMENT,
                              "%s holds %zu cameras; use --path to render them all", file,
                              job->path.count);
    }
    for (size_t i = 0; result == ORL_OK && options->size.width && i < job->path.count; i++) {
        struct orl_camera *camera = &job->path.views[i].camera;
        *camera = orl_camera_reframed(camera, options->size.width, options->size.height);
    }
    return result;
}

static enum orl_result exclude_photos(const struct orl_names *names, struct job *job)
{
    job->skip = orl_array(job->log, job->scene->photo_count, sizeof *job->skip);
    if (!job->skip)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < names->count; i++) {
        int index = orl_scene_find_photo(job->scene, names->items[i]);
        if (index < 0)
            return orl_fail(job->log, ORL_ERR_NOT_FOUND, "%s has no photograph %s",
                            job->scene->dir, names->items[i]);
        job->skip[index] = true;
    }
    return ORL_OK;
}

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
    bool is_path = options->path != NULL;
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
    if (!!options->at + !!options->camera + !!options->path != 1)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "render: one of --at PHOTO, --camera FILE, --path FILE is needed");
    if (!options->path && !orl_frame_can_write(options->out))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: must end in .png or .exr", options->out);
    enum orl_result result = choose_method(options, job);
    if (result == ORL_OK)
        result = orl_scene_open(log, scene_dir, &job->scene);
    if (result == ORL_OK)
        result = choose_views(options, job);
    if (result == ORL_OK)
        result = exclude_photos(&options->exclude, job);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose},
                                &job->gpu);
    struct orl_renderer_params limits = {.max_vram_bytes = (size_t)options->max_vram_mib << 20};
    if (result == ORL_OK)
        result = orl_renderer_create(job->gpu, job->scene, &limits, &job->renderer);
    return result == ORL_OK ? draw_all(options, job) : result;
}

int cmd_render(int argc, char **argv)
{
    struct options o = {.method = "oriel", .frames = 120, .fps = 30, .tone = "srgb", .white = 8,
                        .compression = "zip"};
    const struct arg_option table[] = {
        {"at", ARG_STRING, &o.at, "PHOTO", "from the viewpoint of this photograph", 0, 0},
        {"camera", ARG_STRING, &o.camera, "FILE", "from the camera in FILE", 0, 0},
        {"path", ARG_STRING, &o.path, "FILE",
         "along the cameras in FILE; \"photos\": past all photographs", 0, 0},
        {"out", ARG_STRING, &o.out, "FILE|DIR",
         ".png or .exr; for a path a folder or .mp4", 0, 0},
        {"size", ARG_SIZE, &o.size, "WxH", "picture size; default: the camera's", 0, 0},
        {"method", ARG_STRING, &o.method, "NAME", "oriel (default), airieau or points", 0, 0},
        {"set", ARG_LIST, &o.settings, "KEY=VALUE", "change an option of the method", 0, 0},
        {"exclude", ARG_LIST, &o.exclude, "A,B", "photographs not to use", 0, 0},
        {"layers", ARG_LIST, &o.layers, "A,B", "also write depth, normal, coverage", 0, 0},
        {"exposure", ARG_NUMBER, &o.exposure_ev, "EV", "of .png and .mp4, in stops; default 0",
         -32, 32},
        {"tone", ARG_STRING, &o.tone, "NAME",
         "of .png and .mp4: srgb (default), reinhard, filmic, drago, mantiuk", 0, 0},
        {"white", ARG_NUMBER, &o.white, "L",
         "of reinhard: the luminance that becomes white; default 8", 1e-3, 1e6},
        {"float", ARG_FLAG, &o.float_color, NULL, "of .exr: 32-bit colour; default: 16-bit", 0, 0},
        {"compression", ARG_STRING, &o.compression, "NAME", "of .exr: zip (default) or piz", 0, 0},
        {"frames", ARG_INT, &o.frames, "N", "of --path photos; default 120", 2, 100000},
        {"fps", ARG_NUMBER, &o.fps, "N", "of .mp4; default 30", 1, 240},
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
    orl_names_finish(&o.layers);
    return status;
}
