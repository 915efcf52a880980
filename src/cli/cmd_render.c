// oriel render: renders one view, or every view of a camera path.
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
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
    bool time_runs; // the path leads through the time steps of a sequence
    size_t end;     // pictures of the path before this one are drawn
};

#define RENDER_OPTIONS(ROW) \
    VIEW_OPTIONS(ROW) \
    ROW(time_step, "frame", INT(-1, 0, 1 << 20, "N"), \
        "time step of a sequence, from 0; default: along a path all, else the first") \
    ROW(out, "out", NEEDED("FILE|DIR"), ".png or .exr; for a path a folder or .mp4") \
    METHOD_OPTIONS(ROW) \
    ROW(exclude, "exclude", LIST("A,B"), "photographs not to use") \
    LIGHT_OPTION(ROW) \
    RADIANCE_OPTION(ROW) \
    OUTPUT_OPTIONS(ROW, "also write depth, normal, coverage") \
    ROW(part, "part", PART, "only the K-th of N parts of the frames of a path") \
    ROW(fps, "fps", NUMBER(30, 1, 240, "N"), "of .mp4") \
    TEXTURES_OPTION(ROW) \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
COMMAND_OPTIONS(render_command, RENDER_OPTIONS)

// Of the picture of a path, when time runs.
static int time_step_of(const struct job *job, size_t picture)
{
    return (int)(picture * job->scene->frame_count / job->path.count);
}

static enum orl_result draw(void *priv, const struct orl_view *view, struct orl_frame *frame)
{
    struct job *job = priv;
    size_t picture = (size_t)(view - job->path.views); // sequences draw the views of the path
    enum orl_result result = ORL_OK;
    if (job->time_runs) {
        result = orl_scene_set_frame(job->log, job->scene, time_step_of(job, picture));
        if (picture + 1 < job->end)
            orl_renderer_expect(job->renderer, time_step_of(job, picture + 1));
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

static enum orl_result draw_all(const struct render_command *o, struct job *job)
{
    const char *out = o->out;
    size_t index = (size_t)o->part.index;
    size_t parts = o->part.count ? (size_t)o->part.count : 1;
    job->end = job->path.count * (index + 1) / parts;
    const struct orl_sequence sequence = {
        .views = job->path.views, .first = job->path.count * index / parts,
        .count = job->end, .draw = draw, .priv = job,
        .output = &job->output, .step = "render", .progress = job->progress};
    if (!o->path)
        return orl_sequence_write_view(job->log, &sequence, &job->path.views[0], out);
    if (is_video(out))
        return orl_sequence_write_video(job->log, &sequence, out, o->fps);
    if (orl_frame_can_write(out))
        return orl_fail(job->log, ORL_ERR_ARGUMENT,
                        "--out %s: a path needs a folder or an .mp4 file", out);
    const struct orl_frame_layers *layers = &job->output.layers;
    bool exr = layers->depth || layers->normal || layers->coverage;
    return orl_sequence_write_dir(job->log, &sequence, out, exr ? "exr" : "png");
}

static enum orl_result check(const struct orl_log *log, const struct render_command *o)
{
    if (!!o->at + !!o->camera + !!o->path != 1)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "render: one of --at PHOTO, --camera FILE, --path FILE is needed");
    if (o->part.count && (!o->path || is_video(o->out)))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--part: only the frames of a path in a folder have "
                        "parts");
    if (!o->path && !orl_frame_can_write(o->out))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: must end in .png or .exr", o->out);
    return o->method && !orl_method_find(log, o->method) ? ORL_ERR_ARGUMENT : ORL_OK;
}

static enum orl_result render_scene(const struct render_command *o,
                                    const struct common_options *common, const char *scene_dir,
                                    struct job *job)
{
    const struct orl_log *log = job->log;
    const struct orl_view_choice views = {o->at, o->camera, o->path,
                                          o->frames, o->size.width,
                                          o->size.height};
    struct orl_renderer_params limits = {
        .max_vram_bytes = o->max_vram_bytes,
        .textures = o->textures,
        .progress = job->progress};
    enum orl_result result = check(log, o);
    if (result == ORL_OK)
        result = output_choose(log, OUTPUT_OPTIONS_COPY, false, &job->output);
    if (result == ORL_OK)
        result = orl_scene_open(log, scene_dir, &job->scene);
    if (result == ORL_OK)
        result = orl_scene_set_light(log, job->scene, o->light);
    if (result == ORL_OK && o->time_step >= 0)
        result = orl_scene_set_frame(log, job->scene, o->time_step);
    if (result == ORL_OK)
        limits.radiance = radiance_chosen(log, job->scene, o->wish);
    if (result == ORL_OK)
        result = orl_choice_make(log, job->scene,
                                 limits.radiance ? ORL_SAMPLE_RADIANCE : ORL_SAMPLE_SRGB,
                                 o->method, &o->settings, &job->choice);
    if (result == ORL_OK)
        result = orl_views_choose(log, job->scene, &views, &job->path);
    if (result == ORL_OK)
        result = orl_photos_named(log, job->scene, &o->exclude, &job->skip);
    if (result == ORL_OK)
        result = command_device(log, common, &job->gpu);
    if (result == ORL_OK)
        result = orl_renderer_create(job->gpu, job->scene, &limits, &job->renderer);
    job->time_runs = o->path && o->time_step < 0 && job->scene &&
                     job->scene->frame_count > 0;
    return result == ORL_OK ? draw_all(o, job) : result;
}

static enum orl_result run_render(struct terminal *terminal, const void *options,
                                  const struct common_options *common, const char *const *inputs)
{
    struct job job = {.log = &terminal->log, .progress = &terminal->progress,
                      .output = {ORL_FRAME_OUTPUT_DEFAULTS}};
    enum orl_result result = render_scene(options, common, inputs[0], &job);
    orl_renderer_destroy(&job.renderer);
    orl_gpu_destroy(&job.gpu);
    orl_scene_destroy(&job.scene);
    orl_path_finish(&job.path);
    free(job.skip);
    return result;
}

const struct command command_render = {
    .name = "render", .group = COMMAND_LOOK,
    .brief = "render new views",
    .usage = "SCENE (--at PHOTO | --camera FILE | --path FILE) --out FILE|DIR [options]",
    .summary = "Renders views that nobody photographed.",
    COMMAND_TABLE(render_command), .inputs_min = 1, .inputs_max = 1, .run = run_render,
};
