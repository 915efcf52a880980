// Photographs that a view needs arrive in small steps: the file is read on another thread, then
// the colours are uploaded, then coarse depth is drawn, and last the depth as every other frame has
// it. A software renderer draws coarse depth in a fraction of the time of a frame.
#include "render/photos/photos.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"
#include "core/process.h"

enum {
    COARSE = 4, // coarse depth has 1/COARSE of the size
    ACROSS = 3, // sample directions along x and along y
};

// --- order ---

// The sum of inverse penalties over a few points at the scene's typical distance. A photograph that
// shows none of them comes last, the nearest first.
static double use_of(const struct frame *frame, size_t photo)
{
    const struct orl_view *view = frame->view, *other = &frame->scene->photos[photo].view;
    double typical = frame->scene->photo_distance > 0 ? frame->scene->photo_distance : 1;
    double eye[3], from[3], sum = 0;
    orl_pose_centre(&view->cam_from_world, eye);
    orl_pose_centre(&other->cam_from_world, from);
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        double point[3];
        orl_view_unproject(view, (i % ACROSS + 0.5) * view->camera.width / ACROSS,
                           (i / ACROSS + 0.5) * view->camera.height / ACROSS, typical, point);
        double penalty = orl_photo_penalty(other, eye, view->camera.fx, point);
        sum += penalty > 0 ? 1 / penalty : 0;
    }
    double apart = hypot(hypot(eye[0] - from[0], eye[1] - from[1]), eye[2] - from[2]);
    return sum + 1e-6 / (1 + apart / typical);
}

// --- steps ---

// The photographs of a frame, the most useful first, and the time that is left for them.
struct loading {
    const struct frame *frame;
    bool depth;
    double start_s;
    int steps;     // done so far
    struct orl_ranked *order; // owned
    size_t count;
};

// True if a step that took `cost` seconds last time fits. One step of the first kind always does,
// so that every frame brings the picture forward.
static bool fits(const struct loading *loading, double cost, bool always)
{
    double spent = orl_time_s() - loading->start_s;
    return (always && loading->steps == 0) || spent + cost <= loading->frame->progressive->seconds;
}

// Ends a step that began at `start_s`: its time includes that of the device.
static enum orl_result end_step(struct loading *loading, double start_s, double *cost)
{
    enum orl_result result = orl_gpu_finish(loading->frame->gpu);
    *cost = orl_time_s() - start_s;
    loading->steps++;
    return result;
}

static enum orl_result upload(struct loading *loading, size_t photo)
{
    struct photos *photos = loading->frame->photos;
    struct orl_image image = {0};
    enum orl_result result = ORL_OK;
    switch (orl_photo_loader_take(photos->loader, photo, false, &image)) {
    case PHOTO_AWAITED:
        break;
    case PHOTO_FAILED:
        photos->states[photo].usable = false; // the error has been logged
        break;
    case PHOTO_READ: {
        double start = orl_time_s();
        photos->states[photo].last_use = ++photos->clock;
        result = orl_photos_put(loading->frame->gpu, photos, photo, &image);
        ORL_THEN(result, end_step(loading, start, &photos->costs.color));
        break;
    }
    }
    orl_image_finish(&image);
    return result;
}

static enum orl_result draw_depth(struct loading *loading, size_t photo, int divide)
{
    struct photo_costs *costs = &loading->frame->photos->costs;
    double start = orl_time_s();
    ORL_TRY(orl_photos_draw_depth(loading->frame, photo, divide));
    return end_step(loading, start, divide > 1 ? &costs->coarse : &costs->depth);
}

// The depth of a photograph that is on the device with colours has 1/so much of its size; 0: it lacks one of both.
static int divide_of(const struct loading *loading, size_t photo)
{
    if (!loading->frame->photos->states[photo].has_color)
        return 0;
    return loading->depth ? orl_photos_depth_divide(loading->frame, photo) : 1;
}

// Makes photographs usable, then their depth as fine as other frames have it.
static enum orl_result bring(struct loading *loading)
{
    const struct photos *photos = loading->frame->photos;
    for (size_t i = 0; i < loading->count; i++) {
        size_t photo = loading->order[i].index;
        if (divide_of(loading, photo))
            continue;
        if (!fits(loading, photos->costs.color + photos->costs.coarse, true))
            break;
        if (!photos->states[photo].has_color)
            ORL_TRY(upload(loading, photo));
        if (photos->states[photo].has_color && !divide_of(loading, photo))
            ORL_TRY(draw_depth(loading, photo, COARSE));
    }
    bool at_rest = loading->frame->progressive->at_rest;
    for (size_t i = 0; i < loading->count; i++) {
        size_t photo = loading->order[i].index;
        if (divide_of(loading, photo) <= 1)
            continue;
        if (!fits(loading, photos->costs.depth, at_rest))
            break;
        ORL_TRY(draw_depth(loading, photo, 1));
    }
    return ORL_OK;
}

// --- a frame ---

// Marks the photographs that are there as used, and asks the loader for the others.
static enum orl_result ask(struct loading *loading)
{
    const struct frame *frame = loading->frame;
    struct photos *photos = frame->photos;
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    size_t *absent = orl_array(log, loading->count, sizeof *absent), count = 0;
    enum orl_result result = absent ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < loading->count; i++) {
        size_t photo = loading->order[i].index;
        if (photos->states[photo].has_color)
            photos->states[photo].last_use = ++photos->clock;
        else
            absent[count++] = photo;
    }
    if (result == ORL_OK && !photos->loader)
        result = orl_photo_loader_create(log, frame->scene, photos->radiance, &photos->loader);
    if (result == ORL_OK)
        orl_photo_loader_want(photos->loader, absent, count);
    free(absent);
    return result;
}

// Sorts the photographs of the frame. No more take part than fit on the device.
static enum orl_result sort(const struct frame *frame, struct loading *loading)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    size_t count = frame->chosen_count, most = (size_t)frame->photos->slot_count;
    loading->order = orl_array(log, count, sizeof *loading->order);
    ORL_TRY_MEMORY(loading->order);
    for (size_t i = 0; i < count; i++)
        loading->order[i] = (struct orl_ranked){-use_of(frame, frame->chosen[i]), frame->chosen[i]};
    qsort(loading->order, count, sizeof *loading->order, orl_order_ranked);
    loading->count = count < most ? count : most;
    return ORL_OK;
}

static void remove_absent(struct frame *frame, const struct loading *loading)
{
    size_t kept = 0;
    frame->photos->were_absent = false;
    for (size_t i = 0; i < loading->count; i++)
        frame->photos->were_absent |= frame->photos->states[loading->order[i].index].usable &&
                                      !divide_of(loading, loading->order[i].index);
    for (size_t i = 0; i < frame->chosen_count; i++) {
        if (!divide_of(loading, frame->chosen[i]))
            continue;
        frame->chosen[kept] = frame->chosen[i];
        memmove(frame->selected[kept++], frame->selected[i], sizeof frame->selected[i]);
    }
    frame->chosen_count = kept;
}

enum orl_result orl_progressive_admit(struct frame *frame, bool depth)
{
    struct loading loading = {.frame = frame, .depth = depth};
    frame->progressive->missing = 0;
    if (frame->chosen_count == 0)
        return ORL_OK;
    // The surface is drawn first: its time does not count as that of photographs.
    enum orl_result result = orl_gpu_finish(frame->gpu);
    loading.start_s = orl_time_s();
    ORL_THEN(result, sort(frame, &loading));
    ORL_THEN(result, ask(&loading));
    ORL_THEN(result, bring(&loading));
    for (size_t i = 0; result == ORL_OK && i < loading.count; i++)
        frame->progressive->missing += frame->photos->states[loading.order[i].index].usable &&
                                       divide_of(&loading, loading.order[i].index) != 1;
    if (result == ORL_OK)
        remove_absent(frame, &loading);
    frame->progressive->spent = orl_time_s() - loading.start_s;
    free(loading.order);
    return result;
}

bool orl_progressive_underpaints(const struct frame *frame)
{
    const struct photos *photos = frame->photos;
    return frame->progressive && (photos->were_absent || !photos->loader);
}
