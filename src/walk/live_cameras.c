#include "walk/live_cameras.h"

#include <ctype.h>
#include <dirent.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"

static const double late_s = 1;
enum { DIGITS_MAX = 18 }; // of 64 bits

enum orl_result orl_live_cameras_add(struct orl_live_cameras *cameras, const char *name, const char *folder)
{
    ORL_TRY(ORL_GROW(cameras->log, cameras->cameras, cameras->capacity, cameras->count));
    struct orl_live_camera *camera = &cameras->cameras[cameras->count++];
    *camera = (struct orl_live_camera){.name = orl_strdup(cameras->log, name),
                                       .folder = orl_strdup(cameras->log, folder), .last = -1, .newest = -1};
    return camera->name && camera->folder ? ORL_OK : ORL_ERR_MEMORY;
}

static void forget_pictures(struct orl_live_camera *camera)
{
    for (size_t i = 0; i < camera->count; i++)
        free(camera->pictures[i].path);
    camera->count = 0;
}

void orl_live_cameras_finish(struct orl_live_cameras *cameras)
{
    for (size_t i = 0; i < cameras->count; i++) {
        struct orl_live_camera *camera = &cameras->cameras[i];
        forget_pictures(camera);
        free(camera->pictures);
        free(camera->name);
        free(camera->folder);
        orl_background_finish(&camera->background);
    }
    free(cameras->cameras);
    *cameras = (struct orl_live_cameras){.count = 0};
}

// --- what is there ---

// The number that ends a name before its ending; -1: there is none.
static int64_t number_of(const char *name)
{
    const char *end = strrchr(name, '.'), *begin;
    if (!end || name[0] == '.')
        return -1;
    for (begin = end; begin > name && isdigit((unsigned char)begin[-1]); begin--)
        ;
    return begin < end && end - begin <= DIGITS_MAX ? strtoll(begin, NULL, 10) : -1;
}

// Of numbers, and of pictures, which begin with theirs.
static int compare_numbers(const void *a, const void *b)
{
    int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

static enum orl_result list_pictures(const struct orl_log *log, struct orl_live_camera *camera)
{
    enum orl_result result = ORL_OK;
    DIR *dir = opendir(camera->folder);
    forget_pictures(camera);
    for (struct dirent *entry; result == ORL_OK && dir && (entry = readdir(dir));) {
        int64_t number = number_of(entry->d_name);
        if (number <= camera->last)
            continue;
        result = ORL_GROW(log, camera->pictures, camera->capacity, camera->count);
        char *path = result == ORL_OK ? orl_path_join(log, camera->folder, entry->d_name) : NULL;
        if (path)
            camera->pictures[camera->count++] = (struct orl_live_picture){number, path};
        else
            result = ORL_ERR_MEMORY;
    }
    if (dir)
        closedir(dir);
    if (camera->count > 1)
        qsort(camera->pictures, camera->count, sizeof *camera->pictures, compare_numbers);
    for (size_t i = 0; i < camera->count; i++) {
        int64_t number = camera->pictures[i].number;
        if (camera->newest >= 0 && number > camera->newest)
            camera->intervals[camera->interval_count++ % ORL_LIVE_INTERVALS] = number - camera->newest;
        camera->newest = number > camera->newest ? number : camera->newest;
    }
    return result;
}

// The least of the cameras' median intervals; 0: unknown.
static int64_t interval_of(const struct orl_live_cameras *cameras)
{
    int64_t least = 0;
    for (size_t i = 0; i < cameras->count; i++) {
        const struct orl_live_camera *camera = &cameras->cameras[i];
        size_t count = camera->interval_count;
        count = count < ORL_LIVE_INTERVALS ? count : ORL_LIVE_INTERVALS;
        int64_t sorted[ORL_LIVE_INTERVALS];
        memcpy(sorted, camera->intervals, sizeof sorted);
        qsort(sorted, count, sizeof *sorted, compare_numbers);
        if (count > 0 && (!least || sorted[count / 2] < least))
            least = sorted[count / 2];
    }
    return least;
}

// --- time steps ---

// The oldest picture that is left; NULL: none.
static const struct orl_live_picture *oldest_of(const struct orl_live_camera *camera)
{
    return camera->decided < camera->count ? &camera->pictures[camera->decided] : NULL;
}

static bool is_of(const struct orl_live_picture *picture, int64_t number, int64_t interval)
{
    return picture && (picture->number == number || 2 * (picture->number - number) < interval);
}

// What is known of the pictures that belong to the oldest one that is left.
enum time_step { NONE, WAITS, LACKS, WHOLE };

static enum time_step look_at(const struct orl_live_cameras *cameras, int64_t interval, int64_t *number)
{
    bool any = false, lacks = false, waits = false;
    for (size_t i = 0; i < cameras->count; i++) {
        const struct orl_live_picture *oldest = oldest_of(&cameras->cameras[i]);
        cameras->cameras[i].oldest = oldest;
        if (oldest && (!any || oldest->number < *number))
            *number = oldest->number;
        any = any || oldest;
    }
    for (size_t i = 0; any && i < cameras->count; i++) {
        lacks = lacks || !is_of(cameras->cameras[i].oldest, *number, interval);
        waits = waits || !cameras->cameras[i].oldest;
    }
    // Before an interval is known, different time stamps may be of one time step.
    return !any ? NONE : !lacks ? WHOLE : waits || !interval ? WAITS : LACKS;
}

static void say_missing(const struct orl_live_cameras *cameras, int64_t number, int64_t interval)
{
    for (size_t i = 0; i < cameras->count; i++) {
        struct orl_live_camera *camera = &cameras->cameras[i];
        if (!is_of(camera->oldest, number, interval) && !camera->missing++)
            orl_logf(cameras->log, ORL_LOG_WARNING, "%s: no picture %" PRId64 ", which other cameras have; "
                     "such time steps are left out", camera->name, number);
    }
}

// Says once that a camera stands still while others go on.
static void say_late(const struct orl_live_cameras *cameras, bool waits, double now_s)
{
    for (size_t i = 0; i < cameras->count; i++) {
        struct orl_live_camera *camera = &cameras->cameras[i];
        if (!waits || camera->oldest) {
            camera->waits_since_s = 0;
            camera->is_late = false;
        } else if (camera->waits_since_s <= 0) {
            camera->waits_since_s = now_s;
        } else if (now_s - camera->waits_since_s > late_s && !camera->is_late) {
            camera->is_late = true;
            camera->late++;
            orl_logf(cameras->log, ORL_LOG_WARNING, "%s: no new picture for more than a second, and other "
                     "cameras wait for it", camera->name);
        }
    }
}

static enum orl_result copy_paths(const struct orl_live_cameras *cameras, char **paths)
{
    for (size_t i = 0; i < cameras->count; i++) {
        free(paths[i]);
        paths[i] = orl_strdup(cameras->log, cameras->cameras[i].oldest->path);
        ORL_TRY_MEMORY(paths[i]);
    }
    return ORL_OK;
}

// May a picture belong to the next time step, with a camera that has none of the oldest number?
static bool suits_next(const struct orl_live_cameras *cameras, int64_t number, int64_t interval, int64_t picture)
{
    for (size_t i = 0; i < cameras->count; i++) {
        const struct orl_live_picture *oldest = cameras->cameras[i].oldest;
        if (!is_of(oldest, number, interval) && is_of(oldest, picture, interval))
            return true;
    }
    return false;
}

// Goes on to what is newer than the time step of this number.
static void decide(struct orl_live_cameras *cameras, int64_t number, int64_t interval)
{
    for (size_t i = 0; i < cameras->count; i++) {
        struct orl_live_camera *camera = &cameras->cameras[i];
        const struct orl_live_picture *left;
        while (is_of(left = oldest_of(camera), number, interval) &&
               !suits_next(cameras, number, interval, left->number)) {
            camera->last = left->number;
            camera->decided++;
        }
    }
}

enum orl_result orl_live_cameras_look(struct orl_live_cameras *cameras, double now_s, char **paths)
{
    enum orl_result result = ORL_OK;
    int64_t interval, number = -1;
    enum time_step step = NONE;
    for (size_t i = 0; i < cameras->count; i++) {
        paths[i] = NULL;
        cameras->cameras[i].decided = 0;
    }
    for (size_t i = 0; result == ORL_OK && i < cameras->count; i++)
        result = list_pictures(cameras->log, &cameras->cameras[i]);
    interval = interval_of(cameras);
    while (result == ORL_OK && (step = look_at(cameras, interval, &number)) >= LACKS) {
        if (step == WHOLE)
            result = copy_paths(cameras, paths);
        else
            say_missing(cameras, number, interval);
        decide(cameras, number, interval);
    }
    if (result == ORL_OK)
        say_late(cameras, step == WAITS, now_s);
    for (size_t i = 0; cameras->removes && i < cameras->count; i++)
        for (size_t k = 0; k < cameras->cameras[i].decided; k++)
            if (!paths[i] || strcmp(paths[i], cameras->cameras[i].pictures[k].path) != 0)
                unlink(cameras->cameras[i].pictures[k].path);
    return result;
}
