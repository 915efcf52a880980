// oriel render: renders one view, or every view of a camera path.
#include "cli/command.h"
#include "cli/command_output.h"
#include "eval/choice.h"
#include "render/output/sequence.h"

struct job {
    struct call *call;
    struct orl_choice choice;
    struct orl_frame_output output;
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
    OUTPUT_OPTIONS(ROW, "also write depth, normal, coverage; frames of a path become .exr") \
    ROW(part, "part", PART, "only the K-th of N parts of the frames of a path") \
    TEXTURES_OPTION(ROW) \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
COMMAND_OPTIONS(render_command, RENDER_OPTIONS)

// Of the picture of a path, when time runs.
static int time_step_of(const struct call *call, size_t picture)
{
    return (int)(picture * call->scene->frame_count / call->path.count);
}

static enum orl_result draw(void *priv, const struct orl_view *view, struct orl_frame *frame)
{
    const struct job *job = priv;
    struct call *call = job->call;
    size_t picture = (size_t)(view - call->path.views); // sequences draw the views of the path
    if (job->time_runs) {
        ORL_TRY(orl_scene_set_frame(call->log, call->scene, time_step_of(call, picture)));
        if (picture + 1 < job->end)
            orl_renderer_expect(call->renderer, time_step_of(call, picture + 1));
    }
    return orl_renderer_draw(call->renderer, view, &job->choice.params, call->skip, frame);
}

static enum orl_result draw_all(struct job *job)
{
    const struct call *call = job->call;
    const struct render_command *o = call->options;
    const struct orl_path *path = &call->path;
    size_t index = (size_t)o->part.index;
    size_t parts = o->part.count ? (size_t)o->part.count : 1;
    job->end = path->count * (index + 1) / parts;
    const struct orl_sequence sequence = {
        .views = path->views, .first = path->count * index / parts,
        .count = job->end, .draw = draw, .priv = job,
        .output = &job->output, .step = "render", .progress = call->progress};
    if (!o->path)
        return orl_sequence_write_view(call->log, &sequence, &path->views[0], o->out);
    return orl_sequence_write(call->log, &sequence, o->out, o->layers.count ? "exr" : "png", o->fps);
}

static enum orl_result check(const struct orl_log *log, const struct render_command *o)
{
    if (!!o->at + !!o->camera + !!o->path != 1)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "render: one of --at PHOTO, --camera FILE, --path FILE is needed");
    if (o->part.count && (!o->path || orl_sequence_is_video(o->out)))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--part: only the frames of a path in a folder have "
                        "parts");
    if (o->path)
        ORL_TRY(orl_sequence_check_out(log, o->out, o->part.count, o->layers.count));
    else if (!orl_frame_can_write(o->out))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: must end in .png or .exr", o->out);
    return o->method && !orl_method_find(log, o->method) ? ORL_ERR_ARGUMENT : ORL_OK;
}

static enum orl_result run_render(struct call *call)
{
    const struct render_command *o = call->options;
    struct job job = {.call = call, .output = {ORL_FRAME_OUTPUT_DEFAULTS}};
    struct orl_renderer_params limits = {
        .max_vram_bytes = o->max_vram_bytes,
        .textures = o->textures,
        .progress = call->progress};
    ORL_TRY(check(call->log, o));
    ORL_TRY(output_choose(call->log, OUTPUT_OPTIONS_COPY, false, &job.output));
    ORL_TRY(command_scene(call, o->light));
    if (o->time_step >= 0)
        ORL_TRY(orl_scene_set_frame(call->log, call->scene, o->time_step));
    limits.radiance = radiance_chosen(call->log, call->scene, o->wish);
    ORL_TRY(orl_choice_make(call->log, call->scene,
                            limits.radiance ? ORL_SAMPLE_RADIANCE : ORL_SAMPLE_SRGB,
                            o->method, &o->settings, &job.choice));
    ORL_TRY(orl_views_choose(call->log, call->scene, &VIEW_OPTIONS_COPY, &call->path));
    ORL_TRY(orl_photos_named(call->log, call->scene, &o->exclude, &call->skip));
    ORL_TRY(command_renderer(call, &limits));
    job.time_runs = o->path && o->time_step < 0 && call->scene->frame_count > 0;
    return draw_all(&job);
}

const struct command command_render = {
    .name = "render", .group = COMMAND_LOOK,
    .brief = "render new views",
    .usage = "SCENE (--at PHOTO | --camera FILE | --path FILE) --out FILE|DIR [options]",
    .summary = "Renders views that nobody photographed.",
    COMMAND_TABLE(render_command), .inputs_min = 1, .inputs_max = 1, .run = run_render,
};
