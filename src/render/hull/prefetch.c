#include "render/hull/prefetch.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

// The hull's way; each step is done by a thread of its own (T) or by the caller (C).
enum step {
    STEP_READ,    // T: silhouettes are read
    STEP_CARVE,   // C: the device is asked
    STEP_COLLECT, // C: the device's answer is read
    STEP_LIST,    // T: the surface's voxels are listed, and a mesh is made
    STEP_DONE,
    STEP_NONE,    // there is no hull, or it cannot be made
};

struct prefetch {
    struct orl_scene scene; // of the frame, but showing the time step; photos: a copy
    struct photo_loader *photos;
    size_t *masked;         // photographs whose silhouettes make the hull
    size_t masked_count;
    bool wants_mesh;
    int side;
    uint64_t key;           // orl_voxels_key of the time step
    struct orl_buf *field;  // what the device carves
    enum step step;         // that is done, or is next; cones, voxels and mesh belong to who does it
    bool has_thread;        // that is not joined
    pthread_t thread;
    struct cones cones;
    struct voxels voxels;
    struct orl_mesh mesh;
    struct orl_image *mask; // per photograph of the scene; owned, and filled ahead of STEP_CARVE
};

int orl_prefetch_time_step(const struct prefetch *prefetch)
{
    return prefetch->scene.frame;
}

// --- the threads: they return NULL, or `priv` after a failure ---

static void *read_silhouettes(void *priv)
{
    struct prefetch *a = priv;
    enum orl_result result = orl_cones_read(NULL, &a->scene, a->masked, a->masked_count, a->side, a->mask, &a->cones);
    return result == ORL_OK ? NULL : a;
}

static void *list(void *priv)
{
    struct prefetch *a = priv;
    enum orl_result result = orl_voxels_list(NULL, &a->voxels);
    if (result == ORL_OK && a->wants_mesh)
        result = orl_hull_field_mesh(NULL, &a->voxels.cube, a->voxels.field, 0, &a->mesh);
    return result == ORL_OK ? NULL : a;
}

// Where there is no thread for the step, the frame makes the hull.
static void start(struct prefetch *a, enum step step, void *(*work)(void *))
{
    a->has_thread = pthread_create(&a->thread, NULL, work, a) == 0;
    a->step = a->has_thread ? step : STEP_NONE;
}

// Goes on to the step behind the thread's if that is over; waits: when it is.
static void end_step(struct prefetch *a, bool waits)
{
    void *failed;
    if (!a->has_thread || (waits ? pthread_join(a->thread, &failed) : pthread_tryjoin_np(a->thread, &failed)) != 0)
        return;
    a->has_thread = false;
    a->step = failed ? STEP_NONE : a->step + 1;
}

// --- start and end ---

// Lists the silhouettes that would make the hull of the time step, and starts to read them.
static enum orl_result start_hull(const struct frame *frame, struct prefetch *a)
{
    struct frame next = *frame;
    bool hull = frame->proxy->kind == &orl_proxy_hull, voxels = frame->proxy->kind == &orl_proxy_voxels;
    next.scene = &a->scene;
    a->wants_mesh = hull;
    a->side = orl_voxels_side(frame);
    a->key = orl_voxels_key(&next);
    ORL_TRY(orl_voxels_silhouettes(&next, &a->masked, &a->masked_count));
    a->step = STEP_NONE;
    if ((hull || voxels) && a->masked_count)
        start(a, STEP_READ, read_silhouettes);
    return ORL_OK;
}

enum orl_result orl_prefetch_create(const struct frame *frame, int time_step, struct prefetch **out)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    size_t count = frame->scene->photo_count;
    struct prefetch *a = orl_array(log, 1, sizeof *a);
    *out = a;
    ORL_TRY_MEMORY(a);
    a->scene = *frame->scene;
    a->scene.photos = orl_array(log, count, sizeof *a->scene.photos);
    a->mask = orl_array(log, count, sizeof *a->mask);
    bool whole = a->scene.photos && a->mask;
    enum orl_result result = whole ? ORL_OK : ORL_ERR_MEMORY;
    if (whole) {
        memcpy(a->scene.photos, frame->scene->photos, count * sizeof *a->scene.photos);
        // The check of files that every time step gets which is shown.
        whole = orl_scene_set_frame(NULL, &a->scene, time_step) == ORL_OK;
    }
    if (whole)
        result = start_hull(frame, a);
    if (whole && result == ORL_OK &&
        orl_photo_loader_create(NULL, &a->scene, frame->radiance, &a->photos) != ORL_OK)
        result = orl_fail(log, ORL_ERR_MEMORY, "no thread to read the next time step");
    if (!whole || result != ORL_OK)
        orl_prefetch_destroy(frame->gpu, out);
    return result;
}

void orl_prefetch_destroy(struct orl_gpu *gpu, struct prefetch **prefetch)
{
    struct prefetch *a = *prefetch;
    if (!a)
        return;
    end_step(a, true);
    orl_photo_loader_destroy(&a->photos);
    for (size_t i = 0; a->mask && i < a->scene.photo_count; i++)
        orl_image_finish(&a->mask[i]);
    orl_buf_destroy(gpu, &a->field);
    orl_cones_finish(&a->cones);
    orl_voxels_finish(&a->voxels);
    orl_mesh_finish(&a->mesh);
    free(a->scene.photos);
    free(a->masked);
    free(a->mask);
    free(a);
    *prefetch = NULL;
}

// --- the caller ---

void orl_prefetch_want(struct prefetch *a, const size_t *photos, size_t count)
{
    orl_photo_loader_want(a->photos, photos, count);
}

void orl_prefetch_show(struct prefetch *a, struct photos *photos)
{
    if (a)
        end_step(a, true); // the thread fills the masks
    photos->ahead = a ? a->photos : NULL;
    photos->masks_ahead = a ? a->mask : NULL;
}

enum orl_result orl_prefetch_carve(struct orl_gpu *gpu, struct prefetch *a)
{
    end_step(a, false);
    if (a->step != STEP_CARVE)
        return ORL_OK;
    enum orl_result result = orl_cones_carve(gpu, &a->cones, &a->field);
    a->step = result == ORL_OK ? STEP_COLLECT : STEP_NONE;
    return result;
}

enum orl_result orl_prefetch_collect(struct orl_gpu *gpu, struct prefetch *a)
{
    if (a->step != STEP_COLLECT)
        return ORL_OK;
    enum orl_result result = orl_voxels_read(orl_gpu_log(gpu), &a->cones, a->field, &a->voxels);
    orl_buf_destroy(gpu, &a->field);
    a->step = STEP_NONE;
    if (result == ORL_OK)
        start(a, STEP_LIST, list);
    return result;
}

bool orl_prefetch_take_hull(struct orl_gpu *gpu, struct prefetch *a, uint64_t key,
                            struct voxels *voxels, struct orl_mesh *mesh)
{
    if (!a || a->key != key || (mesh && !a->wants_mesh))
        return false;
    end_step(a, true);
    if (orl_prefetch_carve(gpu, a) != ORL_OK || orl_prefetch_collect(gpu, a) != ORL_OK)
        return false;
    end_step(a, true);
    if (a->step != STEP_DONE)
        return false;
    *voxels = a->voxels;
    memset(&a->voxels, 0, sizeof a->voxels);
    if (mesh) {
        *mesh = a->mesh;
        memset(&a->mesh, 0, sizeof a->mesh);
    }
    a->step = STEP_NONE;
    return true;
}
