// One process at a time, as long as it lives.
#ifndef ORL_CORE_LOCK_H
#define ORL_CORE_LOCK_H

#include "oriel/log.h"

// Locks a folder, or a file that is made where it is not there; *fd holds the lock until it is
// closed, also by the process's end. *taken: another process holds it, and *fd is -1; this is
// no error. Where the drive knows no locks a warning says so, and *fd may be -1.
enum orl_result orl_lock(const struct orl_log *log, const char *path, int *fd,
                         bool *taken) ORL_CHECK_RESULT;
// Gives it up; -1 is fine.
void orl_unlock(int *fd);

#endif
