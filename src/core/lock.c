#include "core/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { TRIES = 100 };

// True while the open file still has this name: the previous holder of the lock may have removed
// the file.
static bool is_there(const char *path, int fd)
{
    struct stat there, ours;
    return stat(path, &there) == 0 && fstat(fd, &ours) == 0 && there.st_dev == ours.st_dev &&
           there.st_ino == ours.st_ino;
}

enum orl_result orl_lock(const struct orl_log *log, const char *path, bool shared, int *fd,
                         bool *taken)
{
    *taken = false;
    for (int i = 0; i < TRIES; i++) {
        // Network file systems lock only files that are open for writing.
        *fd = open(path, O_RDWR | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0666);
        if (*fd < 0 && errno == EISDIR)
            *fd = open(path, O_RDONLY | O_CLOEXEC);
        if (*fd < 0)
            return orl_fail(log, ORL_ERR_IO, "%s: %s", path, strerror(errno));
        if (flock(*fd, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0) {
            *taken = errno == EWOULDBLOCK;
            if (!*taken)
                orl_logf(log, ORL_LOG_WARNING, "%s: cannot be locked (%s): see to it that no other "
                         "oriel works here", path, strerror(errno));
            orl_unlock(fd);
            return ORL_OK;
        }
        if (is_there(path, *fd))
            return ORL_OK;
        orl_unlock(fd);
    }
    return orl_fail(log, ORL_ERR_IO, "%s: removed again and again", path);
}

void orl_unlock(int *fd)
{
    if (*fd >= 0)
        close(*fd);
    *fd = -1;
}
