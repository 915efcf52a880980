#include "render/photos/photo_loader.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "io/picture.h"

enum { READ_AHEAD = 6 }; // photographs that are kept in host memory until the renderer takes them

enum orl_result orl_photo_read(const struct orl_log *log, const struct orl_scene *scene,
                               size_t index, bool linear, struct orl_image *image)
{
    const struct orl_photo *photo = &scene->photos[index];
    const struct orl_camera *c = &photo->view.camera;
    linear = linear && photo->linear;
    char *path = linear ? orl_scene_linear_path(log, scene, index)
                        : orl_scene_photo_path(log, scene, index);
    enum orl_result result = !path   ? ORL_ERR_MEMORY
                             : linear ? orl_picture_read_linear(log, path, image)
                                      : orl_picture_read(log, path, 3, image);
    if (result == ORL_OK && (image->width != c->width || image->height != c->height)) {
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: %dx%d pixels, but its camera has %dx%d", path,
                          image->width, image->height, c->width, c->height);
        orl_image_finish(image);
    }
    free(path);
    return result;
}

// All but the first five members are guarded by `lock`.
struct photo_loader {
    const struct orl_log *log;
    const struct orl_scene *scene;
    bool linear;
    bool has_thread; // the thread itself does not look
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed; // something is wanted, or the thread must end
    bool ends;
    size_t *wanted;         // owned: photographs, the most urgent first
    size_t wanted_count;
    struct orl_image *read; // owned, per photograph of the scene; without pixels: not read
    bool *failed;           // owned, per photograph of the scene
    size_t read_count;
};

// The photograph to read next. Returns false if there is none or too many wait to be taken.
static bool next_photo(const struct photo_loader *l, size_t *photo)
{
    for (size_t i = 0; i < l->wanted_count && l->read_count < READ_AHEAD; i++) {
        *photo = l->wanted[i];
        if (!l->read[*photo].data && !l->failed[*photo])
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
        pthread_mutex_unlock(&l->lock);
        enum orl_result result = orl_photo_read(l->log, l->scene, photo, l->linear, &image);
        pthread_mutex_lock(&l->lock);
        l->failed[photo] = result != ORL_OK;
        if (result != ORL_OK)
            continue;
        l->read[photo] = image;
        l->read_count++;
    }
    pthread_mutex_unlock(&l->lock);
    return NULL;
}

enum orl_result orl_photo_loader_create(const struct orl_log *log, const struct orl_scene *scene,
                                        bool linear, struct photo_loader **out)
{
    struct photo_loader *l = orl_array(log, 1, sizeof *l);
    *out = NULL;
    if (!l)
        return ORL_ERR_MEMORY;
    l->log = log;
    l->scene = scene;
    l->linear = linear;
    l->wanted = orl_array(log, scene->photo_count, sizeof *l->wanted);
    l->read = orl_array(log, scene->photo_count, sizeof *l->read);
    l->failed = orl_array(log, scene->photo_count, sizeof *l->failed);
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->changed, NULL);
    enum orl_result result = l->wanted && l->read && l->failed ? ORL_OK : ORL_ERR_MEMORY;
    l->has_thread = result == ORL_OK && pthread_create(&l->thread, NULL, read_photos, l) == 0;
    if (result == ORL_OK && !l->has_thread)
        result = orl_fail(log, ORL_ERR_MEMORY, "no thread to read photographs");
    *out = l;
    if (result != ORL_OK)
        orl_photo_loader_destroy(out);
    return result;
}

// Forgets photographs that were read and are no longer wanted.
static void drop_unwanted(struct photo_loader *l)
{
    for (size_t i = 0; i < l->scene->photo_count && l->read_count > 0; i++) {
        bool is_wanted = false;
        for (size_t k = 0; k < l->wanted_count; k++)
            is_wanted = is_wanted || l->wanted[k] == i;
        if (is_wanted || !l->read[i].data)
            continue;
        orl_image_finish(&l->read[i]);
        l->read_count--;
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
        pthread_cond_signal(&l->changed);
        pthread_mutex_unlock(&l->lock);
        pthread_join(l->thread, NULL);
        l->wanted_count = 0;
        drop_unwanted(l);
    }
    pthread_mutex_destroy(&l->lock);
    pthread_cond_destroy(&l->changed);
    free(l->wanted);
    free(l->read);
    free(l->failed);
    free(l);
    *loader = NULL;
}

void orl_photo_loader_want(struct photo_loader *l, const size_t *photos, size_t count)
{
    pthread_mutex_lock(&l->lock);
    memcpy(l->wanted, photos, count * sizeof *photos);
    l->wanted_count = count;
    drop_unwanted(l);
    pthread_cond_signal(&l->changed);
    pthread_mutex_unlock(&l->lock);
}

enum photo_arrival orl_photo_loader_take(struct photo_loader *l, size_t photo,
                                         struct orl_image *image)
{
    enum photo_arrival arrival = PHOTO_AWAITED;
    pthread_mutex_lock(&l->lock);
    if (l->failed[photo]) {
        arrival = PHOTO_FAILED;
    } else if (l->read[photo].data) {
        arrival = PHOTO_READ;
        *image = l->read[photo];
        memset(&l->read[photo], 0, sizeof l->read[photo]);
        l->read_count--;
        pthread_cond_signal(&l->changed);
    }
    pthread_mutex_unlock(&l->lock);
    return arrival;
}
