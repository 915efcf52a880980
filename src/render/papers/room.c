#include "render/papers/room.h"

#include <stdio.h>

#include "render/frame/method.h"
#include "render/paint/paint.h"
#include "render/photos/photos.h"
#include "scene/upright.h"

static void place(const struct frame *frame, struct gather_block *block)
{
    const struct orl_pose *pose = &frame->view->cam_from_world;
    double middle[3], half[3], eye[3];
    orl_room_measure(frame->scene, frame->proxy->extent.low, frame->proxy->extent.high, middle, half);
    orl_pose_centre(pose, eye);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            block->local_from_view[i][j] = (float)(pose->r[j][i] / half[i]);
        block->local_from_view[i][3] = (float)((eye[i] - middle[i]) / half[i]);
    }
}

// One batch, into `room`: the photographs of frame->chosen from `first` on, all resident.
static void project(const struct frame *frame, struct orl_tex *room, bool backgrounds, size_t first,
                    size_t count)
{
    struct gather_block block = orl_gather_prepare(frame, first, count);
    char defines[32];
    place(frame, &block);
    // Behind layers the room shows through.
    snprintf(defines, sizeof defines, "SWEEP 0\nROOM %d\n%s",
             frame->params->paint->layers ? 2 : 1,
             frame->scene->room.known ? "" : "SHELL 1\n");
    orl_gpu_pass(frame->gpu, "room", &(struct orl_dispatch){
        .prog = orl_gather_prog(frame, "gather/gather.comp", defines), ORL_PARAMS(block),
        .textures = {backgrounds ? frame->photos->background : frame->photos->color,
                     frame->photos->depth, [ORL_PHOTO_CHROMA] = frame->photos->chroma},
        .images = {frame->surface.depth, room, frame->paint->states[0],
                   [PHOTO_ROWS] = &frame->paint->gather.photos->texels},
        .size = {frame->view->camera.width, frame->view->camera.height}});
}

// Makes `count` photographs ready to be projected.
static enum orl_result require(const struct frame *frame, bool backgrounds, const size_t *photos,
                               size_t count)
{
    for (size_t i = 0; i < count; i++) {
        ORL_TRY(backgrounds ? orl_photos_require_background(frame, photos[i])
                            : orl_photos_require(frame, photos[i], true));
    }
    return ORL_OK;
}

// For a progressive frame: keeps the photographs that are on the device, to which the painter
// brings them, and counts the others as absent. A frame reads one background.
static enum orl_result keep_present(struct frame *frame, bool backgrounds, size_t *absent)
{
    size_t kept = 0;
    bool has_read = false;
    for (size_t i = 0; i < frame->chosen_count; i++) {
        size_t photo = frame->chosen[i];
        bool there = frame->photos->states[photo].has_color;
        if (there && backgrounds && !orl_photos_has_background(frame->photos, photo)) {
            there = !has_read;
            has_read = true;
            ORL_TRY(there ? orl_photos_require_background(frame, photo) : ORL_OK);
        }
        int divide = there && !backgrounds ? orl_photos_depth_divide(frame, photo) : 1;
        if (there && divide > 0)
            frame->chosen[kept++] = photo;
        *absent += !there || divide != 1;
    }
    frame->chosen_count = kept;
    return ORL_OK;
}

enum orl_result orl_room_paint(struct frame *frame, struct orl_tex *room, size_t *absent)
{
    static const struct orl_combine mean = {"mean", .sweeps = 1, .radiance = "gather/radiance/mean.glsl"};
    struct orl_render_params params = *frame->params;
    struct frame walls = *frame; // the frame that the room is painted as
    bool backgrounds = orl_photos_backgrounds(frame->photos);
    walls.params = &params;
    walls.reads_chroma = frame->reads_chroma && !backgrounds;
    snprintf(params.weight, sizeof params.weight, "equal");
    params.combine = &mean;
    if (backgrounds)
        snprintf(params.visibility, sizeof params.visibility, "none");
    *absent = 0;
    orl_tex_clear(room, 0);
    enum orl_result result = orl_select_all.choose(&walls);
    if (result == ORL_OK && frame->progressive)
        result = keep_present(&walls, backgrounds, absent);
    size_t batch = (size_t)frame->photos->slot_count;
    for (size_t first = 0; result == ORL_OK && first < walls.chosen_count; first += batch) {
        size_t left = walls.chosen_count - first, count = left < batch ? left : batch;
        if (!frame->progressive)
            result = require(&walls, backgrounds, walls.chosen + first, count);
        if (result == ORL_OK)
            project(&walls, room, backgrounds, first, count);
    }
    ORL_TRY(result);
    orl_pass_begin(frame->gpu, "room");
    orl_fill_room(frame, room);
    orl_pass_end(frame->gpu);
    return ORL_OK;
}

void orl_room_show(const struct frame *frame, const struct orl_tex *room)
{
    struct image_block block = {.image_size = {frame->surface.width, frame->surface.height},
                                .layers = frame->params->paint->layers};
    orl_gpu_pass(frame->gpu, "room", &(struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, "fill/room.comp", NULL, frame->finishes ? "FINISHED" : NULL),
        ORL_PARAMS(block), .images = {frame->picture, room, frame->surface.depth},
        .size = {frame->surface.width, frame->surface.height}});
}
