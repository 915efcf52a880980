// Files that appear under their final name only when they are complete.
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "core/file.h"

enum {
    LINKS_MAX = 40,     // Linux's own limit
    NAME_TAIL_MAX = 64, // bytes of the final name kept in the temporary name (below NAME_MAX)
    NUMBER_DIGITS = 16,
    STALE_AFTER_S = 60, // a writer locks its temporary file only after creating it
};

const char orl_part_prefix[] = ".oriel-part-";

enum orl_result orl_path_follow(const struct orl_log *log, const char *path, char target[ORL_PATH_SIZE])
{
    char to[ORL_PATH_SIZE];
    ssize_t length;
    orl_path_print(target, "", "%s", path);
    for (int links = 0; (length = readlink(target, to, sizeof to - 1)) >= 0; links++) {
        if (links == LINKS_MAX)
            return orl_fail(log, ORL_ERR_IO, "%s: %s", path, strerror(ELOOP));
        to[length] = '\0';
        size_t dir = *to == '/' ? 0 : (size_t)(orl_path_name(target) - target);
        snprintf(target + dir, ORL_PATH_SIZE - dir, "%s", to);
    }
    return ORL_OK;
}

// With "--json /dev/stdout >FILE" output must go into the file that the shell opened, which a
// rename would replace.
static bool is_standard_stream(const struct stat *st)
{
    struct stat stream;
    for (int fd = STDOUT_FILENO; fd <= STDERR_FILENO; fd++)
        if (fstat(fd, &stream) == 0 && stream.st_dev == st->st_dev && stream.st_ino == st->st_ino)
            return true;
    return false;
}

static enum orl_result begin_direct(const struct orl_log *log, const char *path,
                                    struct orl_atomic_file *file)
{
    file->direct = true;
    orl_path_print(file->path, "", "%s", path);
    orl_path_print(file->temp, "", "%s", path);
    file->fd = open(path, O_WRONLY | O_APPEND | O_NOCTTY | O_CLOEXEC);
    return file->fd >= 0 ? ORL_OK : orl_file_failed(log, path);
}

// The final name comes last and keeps the extension, since writers may choose a format by it.
static const char *name_tail(const char *path)
{
    const char *name = orl_path_name(path);
    size_t length = strlen(name), cut = length > NAME_TAIL_MAX ? length - NAME_TAIL_MAX : 0;
    while (((unsigned char)name[cut] & 0xc0) == 0x80) // some file systems refuse partial characters
        cut++;
    return name + cut;
}

enum orl_result orl_temp_name(const struct orl_log *log, const char *prefix, const char *path,
                              char name[ORL_PATH_SIZE])
{
    unsigned long long number;
    if (getrandom(&number, sizeof number, 0) != sizeof number)
        return orl_file_failed(log, path);
    orl_path_print(name, "", "%.*s%s%0*llx-%s", (int)(orl_path_name(path) - path), path, prefix,
                   NUMBER_DIGITS, number, name_tail(path));
    return ORL_OK;
}

bool orl_temp_is_of(const char *name, const char *prefix, const char *path)
{
    size_t length = strlen(prefix);
    if (strncmp(name, prefix, length) != 0 ||
        strspn(name + length, "0123456789abcdef") != NUMBER_DIGITS)
        return false;
    const char *rest = name + length + NUMBER_DIGITS;
    return *rest == '-' && (!path || strcmp(rest + 1, name_tail(path)) == 0);
}

static enum orl_result open_part(const struct orl_log *log, struct orl_atomic_file *file)
{
    ORL_TRY(orl_temp_name(log, orl_part_prefix, file->path, file->temp));
    file->fd = open(file->temp, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file->fd < 0)
        return orl_file_failed(log, file->path);
    // The lock tells orl_dir_sweep that a writer is active. File systems without locks lack this
    // protection.
    (void)!flock(file->fd, LOCK_EX | LOCK_NB);
    return ORL_OK;
}

enum orl_result orl_atomic_begin(const struct orl_log *log, const char *path,
                                 struct orl_atomic_file *file)
{
    *file = (struct orl_atomic_file){.fd = -1};
    struct stat st;
    bool there = stat(path, &st) == 0;
    enum orl_result result;
    if (there && !S_ISDIR(st.st_mode) && (!S_ISREG(st.st_mode) || is_standard_stream(&st)))
        result = begin_direct(log, path, file);
    else if ((result = orl_path_follow(log, path, file->path)) == ORL_OK)
        result = open_part(log, file);
    if (result == ORL_OK && there && !file->direct)
        (void)!fchmod(file->fd, st.st_mode & 0777); // the new file keeps the old permissions
    if (result != ORL_OK)
        orl_atomic_abort(file);
    return result;
}

enum orl_result orl_atomic_open(const struct orl_log *log, const char *path,
                                struct orl_atomic_file *file)
{
    ORL_TRY(orl_atomic_begin(log, path, file));
    int copy = fcntl(file->fd, F_DUPFD_CLOEXEC, 0);
    file->stream = copy >= 0 ? fdopen(copy, file->direct ? "wb" : "w+b") : NULL;
    if (file->stream)
        return ORL_OK;
    if (copy >= 0)
        close(copy);
    enum orl_result result = orl_file_failed(log, path);
    orl_atomic_abort(file);
    return result;
}

// True if all that was written to the stream is in the file.
static bool close_stream(struct orl_atomic_file *file)
{
    bool good = !ferror(file->stream);
    good = fclose(file->stream) == 0 && good;
    file->stream = NULL;
    return good;
}

// File systems without fsync count as flushed.
static bool flush_to_disk(int fd)
{
    return fsync(fd) == 0 || errno == EINVAL || errno == ENOSYS || errno == ENOTSUP;
}

static enum orl_result flush_file(const struct orl_log *log, const char *path)
{
    int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    enum orl_result result = fd >= 0 && flush_to_disk(fd) ? ORL_OK : orl_file_failed(log, path);
    if (fd >= 0)
        close(fd);
    return result;
}

enum orl_result orl_flush(const struct orl_log *log, const char *path)
{
    struct stat st;
    if (lstat(path, &st) != 0)
        return errno == ENOENT ? ORL_OK : orl_file_failed(log, path);
    if (S_ISREG(st.st_mode))
        return flush_file(log, path);
    return S_ISDIR(st.st_mode) ? orl_dir_each(log, path, orl_flush) : ORL_OK;
}

enum orl_result orl_atomic_commit(const struct orl_log *log, struct orl_atomic_file *file)
{
    enum orl_result result = ORL_OK;
    struct stat st;
    bool streamed = file->stream != NULL;
    if (streamed && !close_stream(file))
        result = orl_file_failed(log, file->path);
    if (result == ORL_OK && !file->direct) {
        if (fstat(file->fd, &st) != 0 || !flush_to_disk(file->fd))
            result = orl_file_failed(log, file->path);
        else if (st.st_size == 0 && !streamed)
            result = orl_fail(log, ORL_ERR_IO, "%s: nothing was written", file->path);
        else if (rename(file->temp, file->path) != 0)
            result = orl_file_failed(log, file->path);
    }
    if (result == ORL_OK)
        file->direct = true; // the abort below then removes nothing
    orl_atomic_abort(file);
    return result;
}

void orl_atomic_abort(struct orl_atomic_file *file)
{
    if (!file)
        return;
    if (file->stream)
        fclose(file->stream);
    if (*file->temp && file->fd >= 0) {
        if (!file->direct)
            unlink(file->temp);
        close(file->fd);
    }
    *file = (struct orl_atomic_file){.fd = -1};
}

enum orl_result orl_file_write(const struct orl_log *log, const char *path, const void *data,
                               size_t size)
{
    struct orl_atomic_file file;
    ORL_TRY(orl_atomic_open(log, path, &file));
    fwrite(data, 1, size, file.stream);
    return orl_atomic_commit(log, &file);
}

// True when no writer is active: the file or folder is old enough and its lock is free.
static bool is_stale(const char *path)
{
    struct stat st;
    int fd = open(path, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0 && errno == EISDIR)
        fd = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    bool stale = fd >= 0 && fstat(fd, &st) == 0 && (S_ISREG(st.st_mode) || S_ISDIR(st.st_mode)) &&
                 time(NULL) - st.st_mtime > STALE_AFTER_S && flock(fd, LOCK_EX | LOCK_NB) == 0;
    if (fd >= 0)
        close(fd);
    return stale;
}

enum orl_result orl_dir_sweep(const struct orl_log *log, const char *dir)
{
    struct orl_names names;
    enum orl_result result = orl_dir_list(log, dir, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        if (!orl_temp_is_of(names.items[i], orl_part_prefix, NULL))
            continue;
        const char *path = ORL_PATH(dir, "%s", names.items[i]);
        if (is_stale(path) && orl_dir_remove(NULL, path) == ORL_OK)
            orl_logf(log, ORL_LOG_DEBUG, "%s: removed, its writer is gone", path);
    }
    orl_names_finish(&names);
    return result;
}
