#include "walk/live_pipes.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/process.h"
#include "io/stream.h"

enum { POLL_MS = 2, PIPE_SIZE = 1 << 20 }; // Linux lets any user have a pipe of so many bytes
static const size_t picture_max = (size_t)1 << 28;

struct pipe {
    const char *path, *folder; // not owned
    int fd;
    uint8_t *bytes; // of a picture that has not ended
    size_t count, capacity;
    int64_t came_ms, last; // when its first bytes came; the number of the last picture
    bool has_foreign;      // bytes of no picture, which has been said
};

struct orl_live_pipes {
    const struct orl_log *log;
    struct pipe *pipes;
    size_t count;
    double start_s;
    pthread_t thread;
    bool has_thread;
    atomic_bool ends;
};

static void forget(struct pipe *pipe, size_t bytes)
{
    memmove(pipe->bytes, pipe->bytes + bytes, pipe->count - bytes);
    pipe->count -= bytes;
}

static enum orl_result write_picture(const struct orl_log *log, struct pipe *pipe, const uint8_t *bytes,
                                     size_t count)
{
    pipe->last = pipe->came_ms > pipe->last ? pipe->came_ms : pipe->last + 1;
    const char *part = ORL_PATH(pipe->folder, ".picture");
    const char *path = ORL_PATH(pipe->folder, "%012" PRId64 ".picture", pipe->last);
    FILE *file = fopen(part, "wb"); // no flush: the next picture follows soon
    bool whole = file && fwrite(bytes, 1, count, file) == count;
    if (file && fclose(file) != 0)
        whole = false;
    return whole && rename(part, path) == 0 ? ORL_OK : orl_file_failed(log, path);
}

// Writes the pictures that are whole.
static enum orl_result cut_pictures(const struct orl_log *log, struct pipe *pipe, int64_t now_ms)
{
    enum orl_result result = ORL_OK;
    size_t begin, length;
    bool found;
    do {
        found = orl_stream_find_picture(pipe->bytes, pipe->count, &begin, &length);
        if (begin > 0 && !pipe->has_foreign) {
            pipe->has_foreign = true;
            orl_logf(log, ORL_LOG_WARNING, "%s: bytes of neither PNG nor JPEG pictures are left out",
                     pipe->path);
        }
        if (found) {
            result = write_picture(log, pipe, pipe->bytes + begin, length);
            pipe->came_ms = now_ms;
        }
        forget(pipe, begin + length);
    } while (result == ORL_OK && found);
    if (result == ORL_OK && pipe->count > picture_max)
        result = orl_fail(log, ORL_ERR_DATA, "%s: a picture of more than 256 MiB", pipe->path);
    return result;
}

// Reads what is there. *any: something was.
static enum orl_result read_pipe(struct orl_live_pipes *pipes, struct pipe *pipe, bool *any)
{
    int64_t now_ms = (int64_t)(1000 * (orl_time_s() - pipes->start_s));
    enum orl_result result = orl_grow(pipes->log, (void **)&pipe->bytes, &pipe->capacity,
                                      pipe->count + PIPE_SIZE, 1);
    ssize_t got = result == ORL_OK ? read(pipe->fd, pipe->bytes + pipe->count, PIPE_SIZE) : -1;
    if (result == ORL_OK && got < 0 && errno != EAGAIN && errno != EINTR)
        result = orl_file_failed(pipes->log, pipe->path);
    if (got == 0)
        pipe->count = 0; // no writer: the next one begins with a new picture
    if (got <= 0)
        return result;
    *any = true;
    pipe->came_ms = pipe->count ? pipe->came_ms : now_ms;
    pipe->count += (size_t)got;
    return cut_pictures(pipes->log, pipe, now_ms);
}

static void *read_pipes(void *priv)
{
    struct orl_live_pipes *pipes = priv;
    while (!atomic_load(&pipes->ends)) {
        bool any = false;
        for (size_t i = 0; i < pipes->count; i++) {
            struct pipe *pipe = &pipes->pipes[i];
            if (pipe->fd >= 0 && read_pipe(pipes, pipe, &any) != ORL_OK) {
                close(pipe->fd); // which ends its writer; the problem has been said
                pipe->fd = -1;
            }
        }
        if (!any)
            nanosleep(&(struct timespec){0, POLL_MS * 1000000}, NULL);
    }
    return NULL;
}

enum orl_result orl_live_pipes_start(const struct orl_live_cameras *cameras, struct orl_live_pipes **pipes_out)
{
    const struct orl_log *log = cameras->log;
    struct orl_live_pipes *pipes = orl_array(log, 1, sizeof *pipes);
    *pipes_out = pipes;
    ORL_TRY_MEMORY(pipes);
    pipes->log = log;
    pipes->start_s = orl_time_s();
    pipes->pipes = orl_array(log, cameras->count, sizeof *pipes->pipes);
    enum orl_result result = pipes->pipes ? ORL_OK : ORL_ERR_MEMORY;
    for (; result == ORL_OK && pipes->count < cameras->count; pipes->count++) {
        const struct orl_live_camera *camera = &cameras->cameras[pipes->count];
        struct pipe *pipe = &pipes->pipes[pipes->count];
        *pipe = (struct pipe){.path = camera->name, .folder = camera->folder, .last = -1, .fd = -1};
        result = orl_dir_make(log, pipe->folder);
        if (result == ORL_OK && (pipe->fd = open(pipe->path, O_RDONLY | O_NONBLOCK | O_CLOEXEC)) < 0)
            result = orl_file_failed(log, pipe->path);
        // A writer that fills a pipe waits until it is read. When one program writes for all cameras in
        // turn, the pictures of a time step then begin too far apart to be paired. It may be refused.
        if (result == ORL_OK)
            fcntl(pipe->fd, F_SETPIPE_SZ, PIPE_SIZE);
    }
    if (result == ORL_OK)
        pipes->has_thread = pthread_create(&pipes->thread, NULL, read_pipes, pipes) == 0;
    if (result == ORL_OK && !pipes->has_thread)
        result = orl_fail(log, ORL_ERR_MEMORY, "no thread to read %s", pipes->pipes[0].path);
    return result;
}

void orl_live_pipes_stop(struct orl_live_pipes **handle)
{
    struct orl_live_pipes *pipes = *handle;
    if (!pipes)
        return;
    atomic_store(&pipes->ends, true);
    if (pipes->has_thread)
        pthread_join(pipes->thread, NULL);
    for (size_t i = 0; i < pipes->count; i++) {
        if (pipes->pipes[i].fd >= 0)
            close(pipes->pipes[i].fd);
        free(pipes->pipes[i].bytes);
    }
    free(pipes->pipes);
    free(pipes);
    *handle = NULL;
}
