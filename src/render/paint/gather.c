#include "render/paint/paint.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "render/frame/method.h"
#include "render/photos/photos.h"
#include "shared/constants.h"

_Static_assert(sizeof(struct photo_data) == 16 * ORL_PHOTO_VEC4S, "photo_data is vec4s");
_Static_assert((int)ORL_SAMPLING_BICUBIC == ORL_BICUBIC, "shaders name it too");

// --- parameters of the shaders ---

static bool is_uniform(const struct orl_option *option)
{
    return option->kind == ORL_VALUE_FLOAT || option->kind == ORL_VALUE_CHOICE;
}

// The define RENDER_OPTIONS: declarations of the options, in the order of struct render_options.
static char *declare_options(const struct orl_log *log)
{
    char *text = orl_strdup(log, "RENDER_OPTIONS");
    for (const struct orl_option *o = orl_render_options(); text && o->name; o++) {
        if (!is_uniform(o))
            continue;
        char *longer = orl_format(log, "%s %s %s;", text, o->kind == ORL_VALUE_FLOAT ? "float" : "int", o->name);
        free(text);
        text = longer;
    }
    return text;
}

enum orl_result orl_gather_init(struct orl_gpu *gpu, size_t photo_count, struct gather *gather)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    memset(gather, 0, sizeof *gather);
    gather->list = orl_array(log, photo_count, sizeof *gather->list);
    gather->options = declare_options(log);
    enum orl_result result = gather->list && gather->options ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_buf_create(gpu, ORL_OWNER_FRAME, "photographs of a frame",
                                photo_count * sizeof *gather->list, NULL, GL_RGBA32F, &gather->photos);
    if (result != ORL_OK)
        orl_gather_finish(gpu, gather);
    return result;
}

void orl_gather_finish(struct orl_gpu *gpu, struct gather *gather)
{
    orl_buf_destroy(gpu, &gather->photos);
    orl_buf_destroy(gpu, &gather->tile_lists);
    free(gather->list);
    free(gather->options);
    memset(gather, 0, sizeof *gather);
}

// photo_from_view = photo_from_world * world_from_view, in doubles, since both translations may be
// large although their difference is small.
static void relative_pose(const struct orl_pose *photo, const struct orl_pose *view,
                          struct photo_data *data)
{
    double eye[3], offset[3], photo_eye[3], in_view[3];
    orl_pose_centre(view, eye);
    orl_pose_centre(photo, photo_eye);
    orl_pose_apply(photo, eye, offset);
    orl_pose_apply(view, photo_eye, in_view);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++)
                sum += photo->r[i][k] * view->r[j][k];
            data->from_view[i][j] = (float)sum;
        }
        data->from_view[i][3] = (float)offset[i];
        data->eye[i] = (float)in_view[i];
    }
}

static void describe_photo(const struct frame *frame, size_t index, struct photo_data *data)
{
    const struct photos *photos = frame->photos;
    const struct orl_photo *photo = &photos->scene->photos[index];
    const struct photo_state *state = &photos->states[index];
    bool aligned = frame->params->alignment == ORL_ALIGNMENT_ON;
    relative_pose(&photo->view.cam_from_world, &frame->view->cam_from_world, data);
    data->eye[3] = (float)state->slot;
    orl_set_focal(&state->color_camera, data->focal);
    data->size[0] = (float)state->color_camera.width;
    data->size[1] = (float)state->color_camera.height;
    struct orl_camera depth = orl_photos_depth_camera(state, state->depth_divide);
    data->size[2] = (float)depth.width;
    data->size[3] = (float)depth.height;
    for (int c = 0; c < 3; c++) {
        data->gain[c] = aligned || frame->radiance ? photo->gain[c] : 1;
        data->lens[c] = aligned ? photo->vignette[c] : 0;
    }
    data->lens[3] = 4 / (data->size[0] * data->size[0] + data->size[1] * data->size[1]);
    data->gain[3] = (float)state->slot;
    if (!frame->radiance)
        return;
    for (int c = 0; c < 3; c++)
        data->gain[c] *= state->white;
    // In units of the colours as stored on the device.
    data->noise[0] = (float)photos->sensor.shot / state->white;
    data->noise[1] = powf((float)photos->sensor.read / state->white, 2);
    data->noise[2] = state->rounded;
}

static void copy_options(const struct orl_render_params *params, struct render_options *opt)
{
    char *next = (char *)opt;
    for (const struct orl_option *o = orl_render_options(); o->name; o++)
        if (is_uniform(o))
            next = mempcpy(next, (const char *)params + o->offset, o->size);
}

int orl_tile_side(const struct frame *frame)
{
    return orl_frame_footprint(frame) >= 1.5 ? 8 : 16;
}

struct gather_block orl_gather_prepare(const struct frame *frame, size_t first, size_t count)
{
    struct gather *g = &frame->paint->gather;
    const struct photos *photos = frame->photos;
    const struct orl_render_params *params = frame->params;
    const struct orl_tex_params *depth = &photos->depth_params;
    const struct orl_tex_params *color = &photos->color_params;
    for (size_t i = 0; i < count; i++) {
        describe_photo(frame, frame->chosen[first + i], &g->list[i]);
        memcpy(g->list[i].selected, frame->selected[first + i], sizeof g->list[i].selected);
    }
    orl_buf_write(g->photos, 0, count * sizeof *g->list, g->list);
    // The bicubic filter reads whole levels.
    orl_tex_mix_levels(photos->color, params->sampling != ORL_SAMPLING_BICUBIC);
    bool fades = strcmp(params->weight, "lumigraph") == 0;
    struct gather_block block = {
        .slot_size = {(float)color->width, (float)color->height, (float)depth->width,
                      (float)depth->height},
        .view_size = {frame->view->camera.width, frame->view->camera.height},
        .photo_count = (int)count,
        .tile_side = orl_tile_side(frame),
        .tiles_across = (int)orl_groups((size_t)frame->view->camera.width, orl_tile_side(frame)),
        .last_mip = (float)(color->levels - 1),
        .border_px = fades ? (float)ORL_BORDER_PX / (float)photos->divide : 0,
        .outlier_severity = params->outliers > 0 ? 1 / (params->outliers * params->outliers) : 0,
        .blur_per_radian = orl_params_guess(frame->params) ? params->guess_blur : 0,
        .model_variance = (float)(photos->sensor.model * photos->sensor.model),
        .min_radiance = orl_least_radiance(&photos->sensor, photos->ev_brightest, true),
    };
    orl_set_focal(&frame->view->camera, block.view_focal);
    orl_frame_ground(frame, block.ground);
    copy_options(params, &block.opt);
    return block;
}

struct orl_prog *orl_gather_prog(const struct frame *frame, const char *file, const char *defines)
{
    const struct orl_render_params *p = frame->params;
    // For radiance, visibility and combination are the same for all methods, since light that bleeds
    // across an edge may be a thousand times as bright as the surface there.
    const char *merge = p->combine->radiance ? p->combine->radiance : "gather/radiance/merge.glsl";
    const bool light = frame->radiance && strcmp(p->visibility, "none") != 0;
    const struct orl_slot slots[] = {
        {"sample", frame->radiance ? "gather/sample/radiance.glsl" : "gather/sample/srgb.glsl"},
        {"visibility", light ? "gather/radiance/light.glsl" : ORL_PATH("gather/visibility", "%s.glsl", p->visibility)},
        {"weight", ORL_PATH("gather/weight", "%s.glsl", p->weight)},
        {"combine", frame->radiance ? merge : ORL_PATH("gather/combine", "%s.glsl", p->combine->name)},
        {0},
    };
    char *text = orl_format(orl_gpu_log(frame->gpu), "%s\n%s%s%s%s", frame->paint->gather.options,
                            frame->reads_chroma ? "CHROMA 1\n" : "",
                            frame->radiance ? "RADIANCE 1\n" : "",
                            p->sampling == ORL_SAMPLING_BICUBIC ? "BICUBIC 1\n" : "",
                            defines ? defines : "");
    struct orl_prog *prog = text ? orl_prog_get(frame->gpu, file, slots, text) : NULL;
    free(text);
    return prog;
}

// --- the generic painter ---

// Lists the photographs that contribute most to each tile. The rest of the dispatch is that of the
// gather.
static enum orl_result choose_radiance(const struct frame *frame, struct orl_dispatch d)
{
    const size_t across = orl_groups((size_t)d.size[0], ORL_PIXEL_GROUP_X);
    const size_t down = orl_groups((size_t)d.size[1], ORL_PIXEL_GROUP_Y);
    ORL_TRY(orl_buf_fit(frame->gpu, ORL_OWNER_FRAME, "photographs of tiles",
                        across * down * ORL_RADIANCE_LIST * sizeof(int), 0, &frame->paint->gather.tile_lists));
    d.prog = orl_gather_prog(frame, "gather/radiance/choose.comp", NULL);
    d.bufs[1] = frame->paint->gather.tile_lists;
    d.size[0] = (int)across;
    d.size[1] = (int)down;
    orl_gpu_pass(frame->gpu, "choose", &d);
    return ORL_OK;
}

static struct orl_prog *generic_program(const struct frame *frame, int sweep)
{
    char defines[32];
    bool limited = frame->radiance && frame->params->paint->finishes;
    snprintf(defines, sizeof defines, "SWEEP %d\n%s", sweep, limited ? "LIMITED 1\n" : "");
    return orl_gather_prog(frame, "gather/gather.comp", defines);
}

static bool reads_normals(const struct frame *frame)
{
    return orl_prog_reads(generic_program(frame, 0), "view_normal") ||
           orl_prog_reads(generic_program(frame, 1), "view_normal");
}

// One sweep over one batch: the photographs of frame->chosen from `first` on, all resident.
static enum orl_result gather(const struct frame *frame, size_t first, size_t count, int sweep)
{
    struct gather_block block = orl_gather_prepare(frame, first, count);
    struct orl_tex *color = frame->photos->color;
    struct orl_dispatch d = {
        .prog = generic_program(frame, sweep),
        ORL_PARAMS(block),
        // Without depth maps no shader reads them, but a sampler wants a texture.
        .textures = {color, frame->photos->depth ? frame->photos->depth : color,
                     [ORL_PHOTO_CHROMA] = frame->photos->chroma},
        .images = {frame->surface.depth, frame->picture,
                   frame->radiance ? frame->paint->trusted : frame->paint->states[0], frame->paint->states[1],
                   frame->surface.normal, [PHOTO_ROWS] = &frame->paint->gather.photos->texels},
        .size = {frame->view->camera.width, frame->view->camera.height}};
    if (frame->radiance) {
        ORL_TRY(choose_radiance(frame, d));
        d.bufs[1] = frame->paint->gather.tile_lists;
    }
    orl_gpu_pass(frame->gpu, "gather", &d);
    return ORL_OK;
}

static bool reads_depth(const struct frame *frame)
{
    const char *visibility = frame->params->visibility;
    // Radiance has a visibility of its own in place of `facing`.
    return strcmp(visibility, "none") != 0 &&
           (frame->radiance || strcmp(visibility, "facing") != 0);
}

// Sweeps over all photographs, in batches of as many as are resident together.
static enum orl_result sweep_over(const struct frame *frame, int sweep)
{
    size_t batch = (size_t)frame->photos->slot_count;
    bool depth = reads_depth(frame);
    for (size_t first = 0; first < frame->chosen_count; first += batch) {
        size_t left = frame->chosen_count - first, count = left < batch ? left : batch;
        for (size_t i = 0; !frame->progressive && i < count; i++)
            ORL_TRY(orl_photos_require(frame, frame->chosen[first + i], depth));
        ORL_TRY(gather(frame, first, count, sweep));
    }
    return ORL_OK;
}

void orl_gather_clear(const struct frame *frame)
{
    struct orl_tex *const targets[] = {frame->picture, frame->paint->trusted, frame->paint->states[0],
                                       frame->paint->states[1]};
    for (size_t i = 0; i < ORL_COUNT(targets); i++)
        if (targets[i])
            orl_tex_clear(targets[i], 0);
}

enum orl_result orl_gather_underpaint(const struct frame *frame)
{
    const struct proxy *proxy = frame->proxy;
    if (!frame->progressive || !frame->photos->were_absent || !proxy->kind->color ||
        !frame->normals)
        return ORL_OK;
    orl_pass_begin(frame->gpu, "gather");
    const struct paint_into into = {frame->picture,
                                    frame->finishes ? frame->paint->fill.level[0] : NULL, true};
    enum orl_result result = orl_proxy_color(frame, &into);
    orl_pass_end(frame->gpu);
    return result;
}

static enum orl_result paint_gather(struct frame *frame)
{
    int sweeps = frame->radiance ? 1 : frame->params->combine->sweeps;
    orl_gather_clear(frame);
    ORL_TRY(frame->params->select->choose(frame));
    if (frame->progressive)
        ORL_TRY(orl_progressive_admit(frame, reads_depth(frame)));
    for (int sweep = 0; sweep < sweeps; sweep++)
        ORL_TRY(sweep_over(frame, sweep));
    return orl_gather_underpaint(frame);
}

const struct orl_combine orl_combine_mean = {"mean", .sweeps = 1};
// Runs shaders/gather/gather.comp with the method's slots, in batches of as many photographs as are resident together.
const struct orl_painter orl_paint_gather = {
    .name = "gather", .needs = "", .reads_normals = reads_normals, .paint = paint_gather};

// --- a painter without photographs ---

static enum orl_result paint_points(struct frame *frame)
{
    orl_pass_begin(frame->gpu, "gather");
    orl_gather_clear(frame);
    const struct paint_into into = {.picture = frame->picture};
    enum orl_result result = orl_proxy_color(frame, &into);
    orl_pass_end(frame->gpu);
    return result;
}

// Splats show where they are in front, as the normal's w tells.
static bool always(const struct frame *frame)
{
    (void)frame;
    return true;
}

// Shows the proxy's own colours, of splats or of a mesh's vertices.
const struct orl_painter orl_paint_points = {
    .name = "points", .needs = "", .reads_normals = always, .paint = paint_points};
