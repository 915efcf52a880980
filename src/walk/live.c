#include "walk/live.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "io/picture.h"
#include "scene/silhouette.h"
#include "walk/live_cameras.h"
#include "walk/live_pipes.h"

enum {
    POLL_MS = 5,
    NUMBERS = 100000, // of the folders of a sequence
    LATENCIES = 1 << 16,
};

struct live {
    const struct orl_log *log;
    struct orl_scene *scene; // the server's thread alone changes it
    struct orl_live_cameras cameras; // named DIR/NAME, a folder or a pipe
    struct orl_live_pipes *pipes; // NULL: cameras write into folders
    char *dir; // owned: frames/NNNNN/ of the time steps that are kept
    pthread_t thread;
    bool has_thread;
    atomic_bool ends;        // the thread
    double first_s, last_s;  // when time steps were ready, the thread's
    size_t steps;            // of the thread
    // The server's thread:
    double waits_since;      // when the picture that was taken last came; 0: it has been drawn
    float *latency_ms;       // of frames drawn
    size_t drawn;

    pthread_mutex_t lock;    // guards the rest
    int ready, taken;        // numbers of time steps; -1: none
    double ready_since;      // when its last picture came
};

static double clock_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now); // that of the files' times
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// --- one time step ---

static enum orl_result write_picture(struct live *live, const struct orl_live_camera *camera, int number,
                                     const char *folder, const char *ending, const char *copied,
                                     const struct orl_image *image)
{
    const char *path = ORL_PATH(live->dir, "frames/%05d/%s/%s%s", number, folder,
                                live->scene->photos[camera->photo].name, ending);
    ORL_TRY(orl_file_make_folder(live->log, path));
    return image ? orl_png_write(live->log, path, image) : orl_file_copy(live->log, copied, path);
}

static enum orl_result take_picture(struct live *live, const struct orl_live_camera *camera, int number,
                                    const char *path)
{
    const struct orl_difference_params params = {ORL_DIFFERENCE_DEFAULTS};
    struct orl_image picture = {0}, mask = {0};
    enum orl_result result = orl_picture_read(live->log, path, 3, &picture);
    ORL_THEN(result, orl_silhouette_difference(live->log, &camera->background, &params, &picture, &mask));
    if (result == ORL_OK) {
        orl_silhouette_mark_edges(&mask);
        result = write_picture(live, camera, number, "masks", ".png", NULL, &mask);
    }
    ORL_THEN(result, write_picture(live, camera, number, "images", "", path, NULL));
    orl_image_finish(&picture);
    orl_image_finish(&mask);
    return result;
}

static void remove_time_step(struct live *live, int number)
{
    const char *path = ORL_PATH(live->dir, "frames/%05d", number);
    if (number >= 0 && orl_dir_remove(live->log, path) != ORL_OK)
        orl_logf(live->log, ORL_LOG_WARNING, "%s: stays", path);
}

// Tells that the time step is there. The one before goes, unless the server draws it.
static void tell_ready(struct live *live, int number, double since)
{
    pthread_mutex_lock(&live->lock);
    int before = live->ready == live->taken ? -1 : live->ready;
    live->ready = number;
    live->ready_since = since;
    pthread_mutex_unlock(&live->lock);
    remove_time_step(live, before);
    live->last_s = clock_s();
    live->first_s = live->steps++ ? live->first_s : live->last_s;
}

// Makes a time step of a picture of each camera.
static void make_time_step(struct live *live, char *const *paths)
{
    enum orl_result result = ORL_OK;
    double since = 0;
    int number = (int)(live->steps % NUMBERS);
    for (size_t i = 0; result == ORL_OK && i < live->cameras.count; i++) {
        struct stat status;
        result = stat(paths[i], &status) == 0
                     ? take_picture(live, &live->cameras.cameras[i], number, paths[i])
                     : orl_fail(live->log, ORL_ERR_NOT_FOUND, "%s: %s", paths[i], strerror(errno));
        if (result == ORL_OK)
            since = fmax(since, (double)status.st_mtim.tv_sec + 1e-9 * (double)status.st_mtim.tv_nsec);
        if (live->pipes)
            unlink(paths[i]);
    }
    if (result == ORL_OK)
        tell_ready(live, number, since);
    else
        remove_time_step(live, number); // a picture that cannot be read has been named
}

static void *watch(void *priv)
{
    struct live *live = priv;
    char **paths = orl_array(live->log, live->cameras.count, sizeof *paths);
    enum orl_result result = paths ? ORL_OK : ORL_ERR_MEMORY;
    while (result == ORL_OK && !atomic_load(&live->ends)) {
        result = orl_live_cameras_look(&live->cameras, clock_s(), paths);
        if (result == ORL_OK && paths[0])
            make_time_step(live, paths);
        else
            nanosleep(&(struct timespec){0, POLL_MS * 1000000}, NULL);
        for (size_t i = 0; i < live->cameras.count; i++)
            free(paths[i]);
    }
    free(paths);
    return NULL;
}

// --- start and end ---

// Finds where a photograph's pictures come from.
static enum orl_result add_camera(struct live *live, const char *dir, size_t photo)
{
    const struct orl_photo *p = &live->scene->photos[photo];
    size_t number = live->cameras.count;
    struct orl_image picture = {0};
    const struct orl_file_path path = orl_scene_file(live->scene, photo, ORL_FILE_BACKGROUND);
    const char *from = ORL_PATH(dir, "%.*s", (int)orl_path_stem(p->name), p->name);
    bool is_pipe = orl_path_is_pipe(from);
    if (!p->masked || !orl_path_is_file(path.text))
        return orl_fail(live->log, ORL_ERR_DATA, "%s: %s has no silhouette or no picture of the empty "
                        "place, which --live needs; import the cameras with --background",
                        live->scene->dir, p->name);
    if (number > 0 && is_pipe != live->cameras.removes) // pipes have time stamps of their own
        return orl_fail(live->log, ORL_ERR_DATA, "%s: some cameras have pipes, others do not", from);
    live->cameras.removes = is_pipe;
    ORL_TRY(orl_live_cameras_add(&live->cameras, from, is_pipe ? ORL_PATH(live->dir, "pipes/%zu", number) : from));
    struct orl_live_camera *camera = &live->cameras.cameras[number];
    camera->photo = photo;
    ORL_TRY(orl_picture_read(live->log, path.text, 3, &picture));
    enum orl_result result = orl_background_add(live->log, &camera->background, &picture);
    orl_image_finish(&picture);
    return result;
}

static enum orl_result add_cameras(struct live *live, const char *dir)
{
    enum orl_result result = ORL_OK;
    const struct orl_scene *scene = live->scene;
    if (!orl_path_is_dir(dir))
        return orl_fail(live->log, ORL_ERR_NOT_FOUND, "%s: no such folder; --live takes the one that holds a "
                        "folder of pictures, or a pipe, for each camera", dir);
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (!scene->photos[i].test)
            result = add_camera(live, dir, i);
    if (result == ORL_OK && !live->cameras.count)
        result = orl_fail(live->log, ORL_ERR_DATA, "%s: all cameras are held out", scene->dir);
    if (result == ORL_OK && live->cameras.removes)
        result = orl_live_pipes_start(&live->cameras, &live->pipes);
    return result;
}

enum orl_result orl_live_start(const struct orl_log *log, struct orl_scene *scene, const char *dir,
                               struct live **out)
{
    struct live *live = orl_array(log, 1, sizeof *live);
    *out = live;
    ORL_TRY_MEMORY(live);
    *live = (struct live){.log = log, .scene = scene, .cameras = {.log = log}, .ready = -1, .taken = -1};
    pthread_mutex_init(&live->lock, NULL);
    live->latency_ms = orl_array(log, LATENCIES, sizeof *live->latency_ms);
    enum orl_result result = live->latency_ms ? orl_dir_make_temporary(log, "live", &live->dir) : ORL_ERR_MEMORY;
    ORL_THEN(result, add_cameras(live, dir));
    scene->time_steps_dir = live->dir;
    if (result == ORL_OK)
        live->has_thread = pthread_create(&live->thread, NULL, watch, live) == 0;
    if (result == ORL_OK && !live->has_thread)
        result = orl_fail(log, ORL_ERR_MEMORY, "no thread to watch %s", dir);
    return result;
}

static void report(const struct live *live)
{
    size_t count = live->drawn < LATENCIES ? live->drawn : LATENCIES;
    double seconds = live->last_s - live->first_s;
    qsort(live->latency_ms, count, sizeof *live->latency_ms, orl_order_floats);
    orl_logf(live->log, ORL_LOG_INFO, "live: %zu time steps, %.1f a second; %zu drawn, a median of %.0f ms "
             "after their last picture", live->steps,
             seconds > 0 ? (double)(live->steps - 1) / seconds : 0, live->drawn,
             count ? (double)live->latency_ms[count / 2] : 0);
    for (size_t i = 0; i < live->cameras.count; i++) {
        const struct orl_live_camera *camera = &live->cameras.cameras[i];
        if (camera->missing || camera->late)
            orl_logf(live->log, ORL_LOG_INFO, "live: %s lacked %zu pictures that others had, and was waited "
                     "for %zu times", camera->name, camera->missing, camera->late);
    }
}

void orl_live_stop(struct live **handle)
{
    struct live *live = *handle;
    if (!live)
        return;
    if (live->has_thread) {
        atomic_store(&live->ends, true);
        pthread_join(live->thread, NULL);
        report(live);
    }
    orl_live_pipes_stop(&live->pipes);
    orl_live_cameras_finish(&live->cameras);
    if (live->dir && orl_dir_remove(live->log, live->dir) != ORL_OK)
        orl_logf(live->log, ORL_LOG_WARNING, "%s: stays", live->dir);
    live->scene->time_steps_dir = NULL;
    pthread_mutex_destroy(&live->lock);
    free(live->latency_ms);
    free(live->dir);
    free(live);
    *handle = NULL;
}

// --- the server ---

int orl_live_take(struct live *live)
{
    int before = -1;
    pthread_mutex_lock(&live->lock);
    if (live->taken != live->ready) {
        before = live->taken;
        live->taken = live->ready;
        live->waits_since = live->ready_since;
    }
    int taken = live->taken;
    pthread_mutex_unlock(&live->lock);
    remove_time_step(live, before);
    if (taken >= 0)
        live->scene->frame_count = (size_t)taken + 1;
    return taken;
}

void orl_live_drawn(struct live *live)
{
    if (live->waits_since > 0) {
        live->latency_ms[live->drawn % LATENCIES] = (float)(1000 * (clock_s() - live->waits_since));
        live->drawn++;
    }
    live->waits_since = 0;
}
