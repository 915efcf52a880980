#include "render/hull/prefetch.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/hull/voxel_proxy.h"

// The hull's way; each step is done by the thread (T) or by the caller (C).
enum step {
    STEP_READ,    // T: silhouettes are read
    STEP_CARVE,   // C: the device is asked
    STEP_COLLECT, // C: the device's answer is read
    STEP_LIST,    // T: the surface's voxels are listed, and a mesh is made
    STEP_DONE,
    STEP_NONE,    // there is no hull, or it cannot be made
};

struct prefetch {
    // Not changed after the start.
    struct orl_scene scene; // of the frame, but showing the time step; photos: a copy
    struct photo_loader *photos;
    size_t *masked;         // photographs whose silhouettes make the hull
    size_t masked_count;
    bool wants_mesh, has_thread;
    int side;
    uint64_t key;           // orl_voxels_key of the time step
    pthread_t thread;
    struct orl_buf *field;  // the caller's: what the device carves

    pthread_mutex_t lock;   // guards the rest
    pthread_cond_t changed;
    bool ends;
    enum step step;         // what is done next; cones, voxels and mesh belong to who does it
    struct cones cones;
    struct voxels voxels;
    struct orl_mesh mesh;
    struct orl_image *mask; // per photograph of the scene; owned, and filled ahead of STEP_CARVE
};

int orl_prefetch_time_step(const struct prefetch *prefetch)
{
    return prefetch->scene.frame;
}

// --- the thread ---

static enum orl_result read_silhouettes(struct prefetch *a)
{
    struct orl_silhouette *all = orl_array(NULL, a->masked_count, sizeof *all);
    enum orl_result result = all ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < a->masked_count; i++) {
        size_t photo = a->masked[i];
        result = orl_photo_mask_read(NULL, &a->scene, photo, &a->mask[photo]);
        all[i] = (struct orl_silhouette){a->scene.photos[photo].view, a->mask[photo]};
    }
    ORL_THEN(result, orl_cones_make(NULL, all, a->masked_count, a->side, &a->cones));
    free(all);
    return result;
}

static enum orl_result list(struct prefetch *a)
{
    enum orl_result result = orl_voxels_list(NULL, &a->voxels);
    if (result == ORL_OK && a->wants_mesh)
        result = orl_hull_field_mesh(NULL, &a->voxels.cube, a->voxels.field, 0,
                                     &a->mesh);
    return result;
}

// Does the hull's next step. The lock is held, but not while it works.
static void go_on(struct prefetch *a)
{
    bool reads = a->step == STEP_READ;
    pthread_mutex_unlock(&a->lock);
    enum orl_result result = reads ? read_silhouettes(a) : list(a);
    pthread_mutex_lock(&a->lock);
    a->step = result != ORL_OK ? STEP_NONE : reads ? STEP_CARVE : STEP_DONE;
    pthread_cond_broadcast(&a->changed);
}

static bool is_of_thread(enum step step)
{
    return step == STEP_READ || step == STEP_LIST;
}

static void *work(void *priv)
{
    struct prefetch *a = priv;
    pthread_mutex_lock(&a->lock);
    while (!a->ends)
        if (is_of_thread(a->step))
            go_on(a);
        else
            pthread_cond_wait(&a->changed, &a->lock);
    pthread_mutex_unlock(&a->lock);
    return NULL;
}

// Waits until the hull's next step is not the thread's.
static void wait_for_hull(struct prefetch *a)
{
    pthread_mutex_lock(&a->lock);
    while (is_of_thread(a->step))
        pthread_cond_wait(&a->changed, &a->lock);
    pthread_mutex_unlock(&a->lock);
}

// --- start and end ---

// Lists the silhouettes that would make the hull of the time step.
static enum orl_result prepare_hull(const struct frame *frame, struct prefetch *a)
{
    struct frame next = *frame;
    bool hull = frame->proxy->kind == &orl_proxy_hull, voxels = frame->proxy->kind == &orl_proxy_voxels;
    next.scene = &a->scene;
    a->step = (hull || voxels) && orl_voxels_silhouettes(&next) ? STEP_READ : STEP_NONE;
    a->wants_mesh = hull;
    a->side = orl_voxels_side(frame);
    a->key = orl_voxels_key(&next);
    a->masked = orl_array(orl_gpu_log(frame->gpu), a->scene.photo_count, sizeof *a->masked);
    for (size_t i = 0; a->masked && i < a->scene.photo_count; i++)
        if (orl_voxels_has_silhouette(&next, i))
            a->masked[a->masked_count++] = i;
    return a->masked ? ORL_OK : ORL_ERR_MEMORY;
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
    pthread_mutex_init(&a->lock, NULL);
    pthread_cond_init(&a->changed, NULL);
    bool whole = a->scene.photos && a->mask;
    enum orl_result result = whole ? ORL_OK : ORL_ERR_MEMORY;
    if (whole) {
        memcpy(a->scene.photos, frame->scene->photos, count * sizeof *a->scene.photos);
        // The check of files that every time step gets which is shown.
        whole = orl_scene_set_frame(NULL, &a->scene, time_step) == ORL_OK;
    }
    if (whole)
        result = prepare_hull(frame, a);
    if (whole && result == ORL_OK) {
        a->has_thread = pthread_create(&a->thread, NULL, work, a) == 0;
        if (!a->has_thread ||
            orl_photo_loader_create(NULL, &a->scene, frame->radiance, &a->photos) != ORL_OK)
            result = orl_fail(log, ORL_ERR_MEMORY, "no thread to read the next time step");
    }
    if (!whole || result != ORL_OK)
        orl_prefetch_destroy(frame->gpu, out);
    return result;
}

void orl_prefetch_destroy(struct orl_gpu *gpu, struct prefetch **prefetch)
{
    struct prefetch *a = *prefetch;
    if (!a)
        return;
    if (a->has_thread) {
        pthread_mutex_lock(&a->lock);
        a->ends = true;
        pthread_cond_broadcast(&a->changed);
        pthread_mutex_unlock(&a->lock);
        pthread_join(a->thread, NULL);
    }
    orl_photo_loader_destroy(&a->photos);
    for (size_t i = 0; a->mask && i < a->scene.photo_count; i++)
        orl_image_finish(&a->mask[i]);
    pthread_mutex_destroy(&a->lock);
    pthread_cond_destroy(&a->changed);
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
        wait_for_hull(a); // the thread fills the masks
    photos->ahead = a ? a->photos : NULL;
    photos->masks_ahead = a ? a->mask : NULL;
}

static enum step step_of(struct prefetch *a)
{
    pthread_mutex_lock(&a->lock);
    enum step step = a->step;
    pthread_mutex_unlock(&a->lock);
    return step;
}

static void set_step(struct prefetch *a, enum step step)
{
    pthread_mutex_lock(&a->lock);
    a->step = step;
    pthread_cond_broadcast(&a->changed);
    pthread_mutex_unlock(&a->lock);
}

enum orl_result orl_prefetch_carve(struct orl_gpu *gpu, struct prefetch *a)
{
    if (step_of(a) != STEP_CARVE)
        return ORL_OK;
    enum orl_result result = orl_cones_carve(gpu, &a->cones, &a->field);
    set_step(a, result == ORL_OK ? STEP_COLLECT : STEP_NONE);
    return result;
}

enum orl_result orl_prefetch_collect(struct orl_gpu *gpu, struct prefetch *a)
{
    if (step_of(a) != STEP_COLLECT)
        return ORL_OK;
    enum orl_result result = orl_voxels_read(orl_gpu_log(gpu), &a->cones, a->field, &a->voxels);
    orl_buf_destroy(gpu, &a->field);
    set_step(a, result == ORL_OK ? STEP_LIST : STEP_NONE);
    return result;
}

void orl_prefetch_wait(struct prefetch *a)
{
    wait_for_hull(a);
    orl_photo_loader_wait(a->photos);
}

bool orl_prefetch_take_hull(struct orl_gpu *gpu, struct prefetch *a, uint64_t key,
                            struct voxels *voxels, struct orl_mesh *mesh)
{
    if (!a || a->key != key || (mesh && !a->wants_mesh))
        return false;
    wait_for_hull(a);
    if (orl_prefetch_carve(gpu, a) != ORL_OK || orl_prefetch_collect(gpu, a) != ORL_OK)
        return false;
    wait_for_hull(a);
    if (step_of(a) != STEP_DONE)
        return false;
    *voxels = a->voxels;
    memset(&a->voxels, 0, sizeof a->voxels);
    if (mesh) {
        *mesh = a->mesh;
        memset(&a->mesh, 0, sizeof a->mesh);
    }
    set_step(a, STEP_NONE);
    return true;
}
