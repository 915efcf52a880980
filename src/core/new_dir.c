#include "core/new_dir.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "core/file.h"

static const char old_prefix[] = ".oriel-old-";
enum { WAITS_MAX = 500, WAIT_NS = 10000000 };

// Whoever looks for other runs and then makes a folder does so alone. -1: there are no locks here,
// or another program holds this one for long.
static int lock_parent(const char *parent)
{
    int fd = open(parent, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (int i = 0; fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) != 0; i++) {
        if (errno == EWOULDBLOCK && i < WAITS_MAX) {
            nanosleep(&(struct timespec){.tv_nsec = WAIT_NS}, NULL);
            continue;
        }
        close(fd);
        fd = -1;
    }
    return fd;
}

static bool is_locked(const char *path)
{
    int fd = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    bool locked = fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (fd >= 0)
        close(fd);
    return locked;
}

static enum orl_result name_dir(const struct orl_log *log, const char *from, const char *to)
{
    return rename(from, to) == 0
               ? ORL_OK
               : orl_fail(log, ORL_ERR_IO, "%s: cannot be named %s: %s", from, to, strerror(errno));
}

// The folder that a run moved out of the way before it ended.
static enum orl_result restore(const struct orl_log *log, const char *old, const char *out)
{
    struct stat st;
    if (lstat(out, &st) != 0 && errno == ENOENT)
        return name_dir(log, old, out);
    orl_logf(log, ORL_LOG_WARNING, "%s: an earlier %s, left by a run that was ended: remove it if "
             "nothing in it is missed", old, out);
    return ORL_OK;
}

static enum orl_result meet_others(const struct orl_log *log, const char *parent, const char *out,
                                   bool over)
{
    struct orl_names names;
    enum orl_result result = orl_dir_list(log, parent, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        const char *path = ORL_PATH(parent, "%s", names.items[i]);
        if (over && orl_temp_is_of(names.items[i], old_prefix, out))
            result = restore(log, path, out);
        else if (orl_temp_is_of(names.items[i], orl_part_prefix, out) && is_locked(path))
            result = orl_fail(log, ORL_ERR_ARGUMENT, "%s: another oriel is making it", out);
    }
    orl_names_finish(&names);
    return result == ORL_OK && orl_dir_sweep(log, parent) == ORL_ERR_MEMORY ? ORL_ERR_MEMORY
                                                                            : result;
}

static enum orl_result make(const struct orl_log *log, struct orl_new_dir *dir)
{
    char outer[ORL_PATH_SIZE];
    ORL_TRY(orl_temp_name(log, orl_part_prefix, dir->out, outer));
    if (mkdir(outer, 0777) != 0)
        return orl_fail(log, ORL_ERR_IO, "%s: no folder can be made beside it: %s", dir->out,
                        strerror(errno));
    memcpy(dir->outer, outer, sizeof outer);
    dir->fd = open(dir->outer, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (dir->fd >= 0)
        (void)!flock(dir->fd, LOCK_EX | LOCK_NB);
    return orl_dir_make(log, orl_path_print(dir->path, dir->outer, "new"));
}

enum orl_result orl_new_dir_refuse_used(const struct orl_log *log, const char *out)
{
    struct orl_names names = {0};
    enum orl_result result = ORL_OK;
    if (orl_path_is_file(out))
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s: is a file", out);
    if (orl_path_is_dir(out))
        result = orl_dir_list(log, out, &names);
    if (result == ORL_OK && names.count)
        result = orl_fail(log, ORL_ERR_ARGUMENT, "%s: not empty; choose another folder", out);
    orl_names_finish(&names);
    return result;
}

enum orl_result orl_new_dir_begin(const struct orl_log *log, const char *out, bool over,
                                  struct orl_new_dir *dir)
{
    *dir = (struct orl_new_dir){.fd = -1, .over = over};
    if (!over)
        ORL_TRY(orl_new_dir_refuse_used(log, out));
    ORL_TRY(orl_path_follow(log, ORL_PATH("", "%.*s", orl_path_bare(out), out), dir->out));
    const char *name = orl_path_name(dir->out);
    const char *parent = name == dir->out ? "." : ORL_PATH("", "%.*s", (int)(name - dir->out), dir->out);
    enum orl_result result = orl_dir_make(log, parent);
    int lock = result == ORL_OK ? lock_parent(parent) : -1;
    ORL_THEN(result, meet_others(log, parent, dir->out, over));
    ORL_THEN(result, make(log, dir));
    if (lock >= 0)
        close(lock);
    if (result != ORL_OK)
        orl_new_dir_abort(log, dir);
    return result;
}

static void close_dir(const struct orl_log *log, struct orl_new_dir *dir)
{
    if (*dir->outer && orl_dir_remove(log, dir->outer) != ORL_OK)
        orl_logf(log, ORL_LOG_WARNING, "%s is left over", dir->outer);
    if (dir->fd >= 0)
        close(dir->fd);
    *dir = (struct orl_new_dir){.fd = -1};
}

// Where names cannot be exchanged. The old folder may be swept once nothing needs it.
static enum orl_result replace_aside(const struct orl_log *log, const struct orl_new_dir *dir)
{
    char old[ORL_PATH_SIZE];
    ORL_TRY(orl_temp_name(log, old_prefix, dir->out, old));
    ORL_TRY(name_dir(log, dir->out, old));
    enum orl_result result = name_dir(log, dir->path, dir->out);
    if (result == ORL_OK)
        return name_dir(log, old, dir->path);
    (void)!rename(old, dir->out);
    return result;
}

enum orl_result orl_new_dir_finish(const struct orl_log *log, struct orl_new_dir *dir)
{
    struct stat st;
    ORL_TRY(orl_flush(log, dir->path));
    if (!dir->over || (lstat(dir->out, &st) != 0 && errno == ENOENT)) {
        ORL_TRY(name_dir(log, dir->path, dir->out));
        close_dir(log, dir);
        return ORL_OK;
    }
    (void)!chmod(dir->path, st.st_mode & 07777); // the new folder keeps the old permissions
    enum orl_result result = ORL_OK;
    if (renameat2(AT_FDCWD, dir->path, AT_FDCWD, dir->out, RENAME_EXCHANGE) != 0)
        result = errno == EINVAL || errno == ENOSYS || errno == ENOTSUP
                     ? replace_aside(log, dir)
                     : orl_fail(log, ORL_ERR_IO, "%s: cannot be named %s: %s", dir->path, dir->out,
                                strerror(errno));
    if (result == ORL_OK) {
        result = orl_dir_remove(log, dir->path); // which is the old one now
        close_dir(log, dir);
    }
    return result;
}

void orl_new_dir_abort(const struct orl_log *log, struct orl_new_dir *dir)
{
    if (*dir->outer || *dir->out)
        close_dir(log, dir);
}
