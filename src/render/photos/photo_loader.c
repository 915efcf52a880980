#include "render/photos/photo_loader.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "io/picture.h"

// Photographs that are read but not taken may take this much host memory, bytes.
static const size_t BYTES_MAX = (size_t)256 << 20;

// Fails and releases the image if it has not the size of its camera.
static enum orl_result check_size(const struct orl_log *log, const struct orl_scene *scene, size_t photo,
                                  const char *path, struct orl_image *image)
{
    const struct orl_camera *c = &scene->photos[photo].view.camera;
    if (image->width == c->width && image->height == c->height)
        return ORL_OK;
    enum orl_result result = orl_fail(log, ORL_ERR_FORMAT, "%s: %dx%d pixels, but its camera has %dx%d", path,
                                      image->width, image->height, c->width, c->height);
    orl_image_finish(image);
    return result;
}

enum orl_result orl_photo_mask_read(const struct orl_log *log, const struct orl_scene *scene, size_t photo,
                                    struct orl_image *mask)
{
    const struct orl_file_path path = orl_scene_file(scene, photo, ORL_FILE_MASK);
    ORL_TRY(orl_picture_read(log, path.text, 1, mask));
    return check_size(log, scene, photo, path.text, mask);
}

enum orl_result orl_photo_read(const struct orl_log *log, const struct orl_scene *scene,
                               size_t index, bool linear, struct orl_image *image)
{
    linear = linear && scene->photos[index].linear;
    const struct orl_file_path path = orl_scene_file(scene, index, linear ? ORL_FILE_LINEAR : ORL_FILE_PHOTO);
    ORL_TRY(linear ? orl_picture_read_linear(log, path.text, image) : orl_picture_read(log, path.text, 3, image));
    return check_size(log, scene, index, path.text, image);
}

enum state { UNREAD, BEING_READ, READ, FAILED, TAKEN };

// All but the first five members are guarded by `lock`.
struct photo_loader {
    const struct orl_log *log;
    struct orl_scene scene; // as it was at the start, while its owner may go on to another time step; photos: owned
    bool linear;
    bool has_thread; // the thread itself does not look
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool ends;
    size_t *wanted;         // owned: photographs, the most urgent first
    size_t wanted_count;
    enum state *states;     // owned, per photograph of the scene
    struct orl_image *read; // owned, per photograph of the scene
    size_t bytes;           // of what is read
};

// The photograph to read next. Returns false if there is none or too much waits to be taken.
static bool next_photo(const struct photo_loader *l, size_t *photo)
{
    for (size_t i = 0; i < l->wanted_count && l->bytes < BYTES_MAX; i++) {
        *photo = l->wanted[i];
        if (l->states[*photo] == UNREAD)
            return true;
    }
    return false;
}

static void *read_photos(void *priv)
{
    struct photo_loader *l = priv;
    pthread_mutex_lock(&l->lock);
    while (!l->ends) {
        size_t photo;
        if (!next_photo(l, &photo)) {
            pthread_cond_wait(&l->changed, &l->lock);
            continue;
        }
        struct orl_image image = {0};
        l->states[photo] = BEING_READ;
        pthread_mutex_unlock(&l->lock);
        enum orl_result result = orl_photo_read(l->log, &l->scene, photo, l->linear, &image);
        pthread_mutex_lock(&l->lock);
        l->states[photo] = result == ORL_OK ? READ : FAILED;
        l->read[photo] = image;
        l->bytes += orl_image_bytes(&image);
        pthread_cond_broadcast(&l->changed);
    }
    pthread_mutex_unlock(&l->lock);
    return NULL;
}

enum orl_result orl_photo_loader_create(const struct orl_log *log, const struct orl_scene *scene,
                                        bool linear, struct photo_loader **out)
{
    struct photo_loader *l = orl_array(log, 1, sizeof *l);
    *out = NULL;
    ORL_TRY_MEMORY(l);
    l->log = log;
    l->scene = *scene;
    l->scene.photos = orl_array(log, scene->photo_count, sizeof *l->scene.photos);
    if (l->scene.photos)
        memcpy(l->scene.photos, scene->photos, scene->photo_count * sizeof *scene->photos);
    l->linear = linear;
    l->wanted = orl_array(log, scene->photo_count, sizeof *l->wanted);
    l->read = orl_array(log, scene->photo_count, sizeof *l->read);
    l->states = orl_array(log, scene->photo_count, sizeof *l->states);
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->changed, NULL);
    enum orl_result result = l->scene.photos && l->wanted && l->read && l->states ? ORL_OK : ORL_ERR_MEMORY;
    l->has_thread = result == ORL_OK && pthread_create(&l->thread, NULL, read_photos, l) == 0;
    if (result == ORL_OK && !l->has_thread)
        result = orl_fail(log, ORL_ERR_MEMORY, "no thread to read photographs");
    *out = l;
    if (result != ORL_OK)
        orl_photo_loader_destroy(out);
    return result;
}

// The image is the caller's now.
static struct orl_image give(struct photo_loader *l, size_t photo, enum state next)
{
    struct orl_image image = l->read[photo];
    l->read[photo] = (struct orl_image){0};
    l->bytes -= orl_image_bytes(&image);
    l->states[photo] = next;
    pthread_cond_broadcast(&l->changed);
    return image;
}

// Forgets photographs that were read and are no longer wanted.
static void drop_unwanted(struct photo_loader *l)
{
    for (size_t i = 0; i < l->scene.photo_count && l->bytes > 0; i++) {
        bool is_wanted = false;
        for (size_t k = 0; k < l->wanted_count; k++)
            is_wanted = is_wanted || l->wanted[k] == i;
        if (is_wanted || l->states[i] != READ)
            continue;
        struct orl_image image = give(l, i, UNREAD);
        orl_image_finish(&image);
    }
}

void orl_photo_loader_destroy(struct photo_loader **loader)
{
    struct photo_loader *l = *loader;
    if (!l)
        return;
    if (l->has_thread) {
        pthread_mutex_lock(&l->lock);
        l->ends = true;
        pthread_cond_broadcast(&l->changed);
        pthread_mutex_unlock(&l->lock);
        pthread_join(l->thread, NULL);
        l->wanted_count = 0;
        drop_unwanted(l);
    }
    pthread_mutex_destroy(&l->lock);
    pthread_cond_destroy(&l->changed);
    free(l->scene.photos);
    free(l->wanted);
    free(l->read);
    free(l->states);
    free(l);
    *loader = NULL;
}

void orl_photo_loader_want(struct photo_loader *l, const size_t *photos, size_t count)
{
    pthread_mutex_lock(&l->lock);
    memcpy(l->wanted, photos, count * sizeof *photos);
    l->wanted_count = count;
    for (size_t i = 0; i < count; i++)
        if (l->states[photos[i]] == TAKEN)
            l->states[photos[i]] = UNREAD;
    drop_unwanted(l);
    pthread_cond_broadcast(&l->changed);
    pthread_mutex_unlock(&l->lock);
}

enum photo_arrival orl_photo_loader_take(struct photo_loader *l, size_t photo, bool now,
                                         struct orl_image *image)
{
    pthread_mutex_lock(&l->lock);
    while (now && l->states[photo] == BEING_READ)
        pthread_cond_wait(&l->changed, &l->lock);
    enum state state = l->states[photo];
    if (state == READ)
        *image = give(l, photo, TAKEN);
    else if (now && state == UNREAD)
        l->states[photo] = TAKEN;
    pthread_mutex_unlock(&l->lock);
    return state == READ ? PHOTO_READ : state == FAILED ? PHOTO_FAILED : PHOTO_AWAITED;
}

void orl_photo_loader_wait(struct photo_loader *l)
{
    pthread_mutex_lock(&l->lock);
    for (bool busy = true; busy;) {
        size_t photo;
        busy = next_photo(l, &photo);
        for (size_t i = 0; i < l->wanted_count; i++)
            busy = busy || l->states[l->wanted[i]] == BEING_READ;
        if (busy)
            pthread_cond_wait(&l->changed, &l->lock);
    }
    pthread_mutex_unlock(&l->lock);
}
