// A lock that one process at a time holds, at most until it ends.
#ifndef ORL_CORE_LOCK_H
#define ORL_CORE_LOCK_H

#include "oriel/log.h"

// Locks a folder or a file; a missing file is created. *fd holds the lock until it is closed or
// the process ends. *taken is set when another process holds the lock; *fd is -1 then, and the
// result is ORL_OK. Where the file system has no locks a warning says so, and *fd may be -1.
// Any number of processes hold a `shared` lock at once, while none holds the other kind.
enum orl_result orl_lock(const struct orl_log *log, const char *path, bool shared, int *fd,
                         bool *taken) ORL_CHECK_RESULT;
// Releases the lock; -1 is accepted.
void orl_unlock(int *fd);

#endif
