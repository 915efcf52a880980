#include "walk/live.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"
#include "io/picture.h"
#include "scene/silhouette.h"

enum {
    POLL_MS = 5,
    NUMBER_MAX = 99999, // of the folders of a sequence
    LATENCIES = 1 << 16,
};

struct camera {
    size_t photo;      // of the scene
    char *folder;      // owned: DIR/NAME
    struct orl_background background;
    int newest;        // number of its newest picture; -1: none
    size_t missing;    // pictures that it lacks and others have
};

struct live {
    const struct orl_log *log;
    struct orl_scene *scene; // the server's thread alone changes it
    struct camera *cameras;
    size_t camera_count;
    char *dir; // owned: frames/NNNNN/ of the time steps that are kept
    pthread_t thread;
    bool has_thread;
    double first_s, last_s;  // when time steps were ready, the thread's
    size_t steps;            // of the thread
    // The server's thread:
    double waits_since;      // when the picture that was taken last came; 0: it has been drawn
    float *latency_ms;       // of frames drawn
    size_t drawn;

    pthread_mutex_t lock;    // guards the rest
    bool ends;
    int ready, taken;        // numbers of time steps; -1: none
    double ready_since;      // when its last picture came
};

static double clock_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now); // that of the files' times
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// --- pictures as they come ---

// The number that ends a name before its ending; -1: there is none.
static int number_of(const char *name)
{
    const char *end = strrchr(name, '.'), *begin;
    if (!end || name[0] == '.')
        return -1;
    for (begin = end; begin > name && isdigit((unsigned char)begin[-1]); begin--)
        ;
    long number = begin < end && end - begin < 10 ? strtol(begin, NULL, 10) : -1;
    return number <= NUMBER_MAX ? (int)number : -1;
}

// The picture of this number, owned by the caller; NULL: it is not there. *newest: the greatest number.
static char *find_picture(const struct camera *camera, int number, int *newest)
{
    char *found = NULL;
    DIR *dir = opendir(camera->folder);
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        int here = number_of(entry->d_name);
        *newest = here > *newest ? here : *newest;
        if (here >= 0 && here == number && !found)
            found = orl_path_join(NULL, camera->folder, entry->d_name);
    }
    if (dir)
        closedir(dir);
    return found;
}

// The greatest number after `last` that all cameras have reached; -1: none.
static int next_number(struct live *live, int last)
{
    int number = INT_MAX;
    for (size_t i = 0; i < live->camera_count; i++) {
        free(find_picture(&live->cameras[i], -1, &live->cameras[i].newest));
        number = live->cameras[i].newest < number ? live->cameras[i].newest : number;
    }
    return number > last ? number : -1;
}

// --- one time step ---

static enum orl_result write_picture(struct live *live, const struct camera *camera, int number,
                                     const char *folder, const char *ending, const char *copied,
                                     const struct orl_image *image)
{
    char *path = orl_format(live->log, "%s/frames/%05d/%s/%s%s", live->dir, number, folder,
                            live->scene->photos[camera->photo].name, ending);
    enum orl_result result = path ? orl_file_make_folder(live->log, path) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = image ? orl_png_write(live->log, path, image) : orl_file_copy(live->log, copied, path);
    free(path);
    return result;
}

static enum orl_result take_picture(struct live *live, const struct camera *camera, int number,
                                    const char *path)
{
    const struct orl_difference_params params = {ORL_DIFFERENCE_DEFAULTS};
    struct orl_image picture = {0}, mask = {0};
    enum orl_result result = orl_picture_read(live->log, path, 3, &picture);
    if (result == ORL_OK)
        result = orl_silhouette_difference(live->log, &camera->background, &params, &picture, &mask);
    if (result == ORL_OK) {
        orl_silhouette_mark_edges(&mask);
        result = write_picture(live, camera, number, "masks", ".png", NULL, &mask);
    }
    if (result == ORL_OK)
        result = write_picture(live, camera, number, "images", "", path, NULL);
    orl_image_finish(&picture);
    orl_image_finish(&mask);
    return result;
}

static void remove_time_step(struct live *live, int number)
{
    char *path = number >= 0 ? orl_format(live->log, "%s/frames/%05d", live->dir, number) : NULL;
    if (path && orl_dir_remove(live->log, path) != ORL_OK)
        orl_logf(live->log, ORL_LOG_WARNING, "%s: stays", path);
    free(path);
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

// Makes the time step of this number, which all cameras have.
static void make_time_step(struct live *live, int number)
{
    enum orl_result result = ORL_OK;
    double since = 0;
    for (size_t i = 0; result == ORL_OK && i < live->camera_count; i++) {
        struct camera *camera = &live->cameras[i];
        struct stat status;
        char *path = find_picture(camera, number, &camera->newest);
        result = path && stat(path, &status) == 0 ? take_picture(live, camera, number, path)
                                                  : ORL_ERR_NOT_FOUND;
        if (result == ORL_OK)
            since = fmax(since, (double)status.st_mtim.tv_sec + 1e-9 * (double)status.st_mtim.tv_nsec);
        free(path);
    }
    if (result == ORL_OK)
        tell_ready(live, number, since);
    else
        remove_time_step(live, number); // a picture that cannot be read has been named
}

// Do all cameras have this number? Says which one lacks what others have.
static bool is_whole(struct live *live, int number)
{
    size_t there = 0;
    bool lacks = false;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < live->camera_count; i++) {
            struct camera *camera = &live->cameras[i];
            char *path = find_picture(camera, number, &camera->newest);
            there += pass == 0 && path;
            lacks = lacks || !path;
            if (pass == 1 && there && !path && !camera->missing++)
                orl_logf(live->log, ORL_LOG_WARNING, "%s: no picture %d, which other cameras have; such "
                         "time steps are left out", camera->folder, number);
            free(path);
        }
    return !lacks;
}

static bool ends(struct live *live)
{
    pthread_mutex_lock(&live->lock);
    bool answer = live->ends;
    pthread_mutex_unlock(&live->lock);
    return answer;
}

static void *watch(void *priv)
{
    struct live *live = priv;
    int last = -1;
    while (!ends(live)) {
        int number = next_number(live, last), whole = -1;
        for (int n = last >= 0 ? last + 1 : number; number >= 0 && n <= number; n++)
            whole = is_whole(live, n) ? n : whole;
        last = number >= 0 ? number : last;
        if (whole >= 0)
            make_time_step(live, whole);
        else
            nanosleep(&(struct timespec){0, POLL_MS * 1000000}, NULL);
    }
    return NULL;
}

// --- start and end ---

static enum orl_result add_camera(struct live *live, const char *dir, size_t photo)
{
    const struct orl_photo *p = &live->scene->photos[photo];
    struct camera *camera = &live->cameras[live->camera_count++];
    const char *dot = strrchr(p->name, '.');
    struct orl_image picture = {0};
    char *path = orl_scene_background_path(live->log, live->scene, photo);
    *camera = (struct camera){.photo = photo, .newest = -1};
    camera->folder = orl_format(live->log, "%s/%.*s", dir,
                                dot ? (int)(dot - p->name) : (int)strlen(p->name), p->name);
    enum orl_result result = path && camera->folder ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK && (!p->masked || !orl_path_is_file(path)))
        result = orl_fail(live->log, ORL_ERR_DATA, "%s: %s has no silhouette or no picture of the empty "
                          "place, which --live needs; import the cameras with --background",
                          live->scene->dir, p->name);
    if (result == ORL_OK)
        result = orl_picture_read(live->log, path, 3, &picture);
    if (result == ORL_OK)
        result = orl_background_add(live->log, &camera->background, &picture);
    orl_image_finish(&picture);
    free(path);
    return result;
}

enum orl_result orl_live_start(const struct orl_log *log, struct orl_scene *scene, const char *dir,
                               struct live **out)
{
    struct live *live = orl_array(log, 1, sizeof *live);
    *out = live;
    if (!live)
        return ORL_ERR_MEMORY;
    *live = (struct live){.log = log, .scene = scene, .ready = -1, .taken = -1};
    pthread_mutex_init(&live->lock, NULL);
    const char *base = getenv("TMPDIR");
    live->cameras = orl_array(log, scene->photo_count, sizeof *live->cameras);
    live->latency_ms = orl_array(log, LATENCIES, sizeof *live->latency_ms);
    live->dir = orl_format(log, "%s/oriel-live-XXXXXX", base && *base ? base : "/tmp");
    enum orl_result result = live->cameras && live->latency_ms && live->dir ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK && !orl_path_is_dir(dir))
        result = orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no such folder; --live takes the one that holds a "
                          "folder of pictures for each camera", dir);
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (!scene->photos[i].test)
            result = add_camera(live, dir, i);
    if (result == ORL_OK && !live->camera_count)
        result = orl_fail(log, ORL_ERR_DATA, "%s: all cameras are held out", scene->dir);
    if (result == ORL_OK && !mkdtemp(live->dir))
        result = orl_fail(log, ORL_ERR_IO, "%s: %s", live->dir, strerror(errno));
    else if (result == ORL_OK)
        scene->time_steps_dir = live->dir;
    if (result == ORL_OK)
        live->has_thread = pthread_create(&live->thread, NULL, watch, live) == 0;
    if (result == ORL_OK && !live->has_thread)
        result = orl_fail(log, ORL_ERR_MEMORY, "no thread to watch %s", dir);
    if (result != ORL_OK)
        orl_live_stop(out);
    return result;
}

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void report(const struct live *live)
{
    size_t count = live->drawn < LATENCIES ? live->drawn : LATENCIES;
    double seconds = live->last_s - live->first_s;
    qsort(live->latency_ms, count, sizeof *live->latency_ms, compare_floats);
    orl_logf(live->log, ORL_LOG_INFO, "live: %zu time steps, %.1f a second; %zu drawn, a median of %.0f ms "
             "after their last picture", live->steps,
             seconds > 0 ? (double)(live->steps - 1) / seconds : 0, live->drawn,
             count ? (double)live->latency_ms[count / 2] : 0);
    for (size_t i = 0; i < live->camera_count; i++)
        if (live->cameras[i].missing)
            orl_logf(live->log, ORL_LOG_INFO, "live: %s lacked %zu pictures that others had",
                     live->cameras[i].folder, live->cameras[i].missing);
}

void orl_live_stop(struct live **handle)
{
    struct live *live = *handle;
    if (!live)
        return;
    if (live->has_thread) {
        pthread_mutex_lock(&live->lock);
        live->ends = true;
        pthread_mutex_unlock(&live->lock);
        pthread_join(live->thread, NULL);
        report(live);
    }
    if (live->scene->time_steps_dir) {
        if (orl_dir_remove(live->log, live->dir) != ORL_OK)
            orl_logf(live->log, ORL_LOG_WARNING, "%s: stays", live->dir);
        live->scene->time_steps_dir = NULL;
    }
    for (size_t i = 0; live->cameras && i < live->camera_count; i++) {
        free(live->cameras[i].folder);
        orl_background_finish(&live->cameras[i].background);
    }
    pthread_mutex_destroy(&live->lock);
    free(live->cameras);
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
