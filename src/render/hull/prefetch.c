#include "render/hull/prefetch.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/hull/voxel_proxy.h"

// Photographs that are read but not taken may take this much host memory, bytes.
static const size_t PHOTO_BYTES_MAX = (size_t)256 << 20;

// The hull's way; each step is done by the thread (T) or by the caller (C).
enum step {
    STEP_READ,    // T: silhouettes are read
    STEP_CARVE,   // C: the device is asked
    STEP_COLLECT, // C: the device's answer is read
    STEP_LIST,    // T: the surface's voxels are listed, and a mesh is made
    STEP_DONE,
    STEP_NONE,    // there is no hull, or it cannot be made
};

enum arrival { UNREAD, BEING_READ, READ, TAKEN };

struct prefetch {
    struct photo_source source; // first: the functions that take pictures get it
    struct orl_scene scene; // the thread's: of the frame, but showing the time step; photos: a copy
    // Not changed after the start.
    int time_step;
    size_t photo_count;
    size_t *masked;         // photographs whose silhouettes make the hull
    size_t masked_count;
    bool linear, wants_mesh, has_thread;
    int side;
    uint64_t key;           // orl_voxels_key of the time step
    pthread_t thread;
    struct orl_buf *field;  // the caller's: what the device carves

    pthread_mutex_t lock;   // guards the rest
    pthread_cond_t changed;
    bool ends, broken;      // broken: files of the time step are missing
    enum step step;         // what is done next; cones, voxels and mesh belong to who does it
    struct cones cones;
    struct voxels voxels;
    struct orl_mesh mesh;
    struct orl_image *mask, *photo; // per photograph of the scene
    enum arrival *arrival;          // of photographs
    size_t *wanted, wanted_count, bytes;
};

int orl_prefetch_time_step(const struct prefetch *prefetch)
{
    return prefetch->time_step;
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
    ORL_THEN(result, orl_cones_make(NULL, all, a->masked_count, &a->cones));
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

static bool next_photo(const struct prefetch *a, size_t *photo)
{
    for (size_t i = 0; i < a->wanted_count && a->bytes < PHOTO_BYTES_MAX; i++) {
        *photo = a->wanted[i];
        if (a->arrival[*photo] == UNREAD)
            return true;
    }
    return false;
}

// As go_on, of a photograph.
static void read_photo(struct prefetch *a, size_t photo)
{
    struct orl_image image = {0};
    a->arrival[photo] = BEING_READ;
    pthread_mutex_unlock(&a->lock);
    enum orl_result result = orl_photo_read(NULL, &a->scene, photo, a->linear, &image);
    pthread_mutex_lock(&a->lock);
    a->arrival[photo] = result == ORL_OK ? READ : TAKEN;
    a->photo[photo] = image;
    a->bytes += result == ORL_OK ? orl_image_bytes(&image) : 0;
    pthread_cond_broadcast(&a->changed);
}

static void *work(void *priv)
{
    struct prefetch *a = priv;
    // The scene's check of its files, as it is done for every time step that is shown.
    bool broken = orl_scene_set_frame(NULL, &a->scene, a->time_step) != ORL_OK;
    pthread_mutex_lock(&a->lock);
    a->broken = broken;
    if (broken)
        a->step = STEP_NONE;
    pthread_cond_broadcast(&a->changed);
    while (!a->ends && !a->broken) {
        size_t photo;
        if (is_of_thread(a->step))
            go_on(a);
        else if (next_photo(a, &photo))
            read_photo(a, photo);
        else
            pthread_cond_wait(&a->changed, &a->lock);
    }
    pthread_mutex_unlock(&a->lock);
    return NULL;
}

// --- pictures ---

// Waits until the hull's next step is not the thread's.
static void wait_for_hull(struct prefetch *a)
{
    pthread_mutex_lock(&a->lock);
    while (is_of_thread(a->step))
        pthread_cond_wait(&a->changed, &a->lock);
    pthread_mutex_unlock(&a->lock);
}

static bool take_photo(struct photo_source *source, size_t photo, struct orl_image *image)
{
    struct prefetch *a = (struct prefetch *)source;
    pthread_mutex_lock(&a->lock);
    while (a->arrival[photo] == BEING_READ)
        pthread_cond_wait(&a->changed, &a->lock);
    bool there = a->arrival[photo] == READ;
    a->arrival[photo] = TAKEN; // the caller reads it now if it is not there
    if (there) {
        *image = a->photo[photo];
        memset(&a->photo[photo], 0, sizeof a->photo[photo]);
        a->bytes -= orl_image_bytes(image);
        pthread_cond_broadcast(&a->changed);
    }
    pthread_mutex_unlock(&a->lock);
    return there;
}

static bool take_mask(struct photo_source *source, size_t photo, struct orl_image *mask)
{
    struct prefetch *a = (struct prefetch *)source;
    wait_for_hull(a); // the thread fills the masks
    bool there = a->mask[photo].data != NULL;
    if (there) {
        *mask = a->mask[photo];
        memset(&a->mask[photo], 0, sizeof a->mask[photo]);
    }
    return there;
}

struct photo_source *orl_prefetch_source(struct prefetch *a)
{
    return a ? &a->source : NULL;
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
    if (!a)
        return ORL_ERR_MEMORY;
    a->source = (struct photo_source){take_photo, take_mask};
    a->scene = *frame->scene;
    a->scene.frame = a->time_step = time_step;
    a->photo_count = count;
    a->linear = frame->radiance;
    a->scene.photos = orl_array(log, count, sizeof *a->scene.photos);
    a->mask = orl_array(log, count, sizeof *a->mask);
    a->photo = orl_array(log, count, sizeof *a->photo);
    a->arrival = orl_array(log, count, sizeof *a->arrival);
    a->wanted = orl_array(log, count, sizeof *a->wanted);
    pthread_mutex_init(&a->lock, NULL);
    pthread_cond_init(&a->changed, NULL);
    enum orl_result result =
        a->scene.photos && a->mask && a->photo && a->arrival && a->wanted ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        memcpy(a->scene.photos, frame->scene->photos, count * sizeof *a->scene.photos);
        result = prepare_hull(frame, a);
    }
    a->has_thread = result == ORL_OK && pthread_create(&a->thread, NULL, work, a) == 0;
    if (result == ORL_OK && !a->has_thread)
        result = orl_fail(log, ORL_ERR_MEMORY, "no thread to read the next time step");
    if (result != ORL_OK)
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
    for (size_t i = 0; a->mask && a->photo && i < a->photo_count; i++) {
        orl_image_finish(&a->mask[i]);
        orl_image_finish(&a->photo[i]);
    }
    pthread_mutex_destroy(&a->lock);
    pthread_cond_destroy(&a->changed);
    orl_buf_destroy(gpu, &a->field);
    orl_cones_finish(&a->cones);
    orl_voxels_finish(&a->voxels);
    orl_mesh_finish(&a->mesh);
    free(a->scene.photos);
    free(a->masked);
    free(a->mask);
    free(a->photo);
    free(a->arrival);
    free(a->wanted);
    free(a);
    *prefetch = NULL;
}

// --- the caller ---

void orl_prefetch_want(struct prefetch *a, const size_t *photos, size_t count)
{
    pthread_mutex_lock(&a->lock);
    memcpy(a->wanted, photos, count * sizeof *photos);
    a->wanted_count = count;
    pthread_cond_broadcast(&a->changed);
    pthread_mutex_unlock(&a->lock);
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
    enum orl_result result = orl_cones_carve(gpu, &a->cones, a->side, &a->field);
    set_step(a, result == ORL_OK ? STEP_COLLECT : STEP_NONE);
    return result;
}

enum orl_result orl_prefetch_collect(struct orl_gpu *gpu, struct prefetch *a)
{
    if (step_of(a) != STEP_COLLECT)
        return ORL_OK;
    enum orl_result result =
        orl_voxels_read(orl_gpu_log(gpu), &a->cones, a->side, a->field, &a->voxels);
    orl_buf_destroy(gpu, &a->field);
    set_step(a, result == ORL_OK ? STEP_LIST : STEP_NONE);
    return result;
}

void orl_prefetch_wait(struct prefetch *a)
{
    size_t photo;
    wait_for_hull(a);
    pthread_mutex_lock(&a->lock);
    for (bool busy = true; busy && !a->broken;) {
        busy = next_photo(a, &photo);
        for (size_t i = 0; i < a->wanted_count; i++)
            busy = busy || a->arrival[a->wanted[i]] == BEING_READ;
        if (busy)
            pthread_cond_wait(&a->changed, &a->lock);
    }
    pthread_mutex_unlock(&a->lock);
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
