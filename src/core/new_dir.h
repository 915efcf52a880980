// Folders that appear under their final name only when they are complete.
#ifndef ORL_CORE_NEW_DIR_H
#define ORL_CORE_NEW_DIR_H

#include "oriel/log.h"

// A folder that is filled beside its final place, in a folder whose random name nobody else has, and
// takes its own name once it is whole and flushed. Where the final name is a symbolic link, the
// link stays and the folder takes the name that it leads to. Two runs do not fill the same folder
// at once: the second is refused.
struct orl_new_dir {
    char path[ORL_PATH_SIZE];  // where its files go until it is finished
    char out[ORL_PATH_SIZE];   // its final name
    char outer[ORL_PATH_SIZE]; // the folder around `path`; "": none has been made
    int fd;                    // of `outer`, which is locked: no other run takes it for one that was left
    bool over;                 // replaces what has its final name
};

// ORL_ERR_ARGUMENT, logged: `out` is a file or a folder that is not empty.
enum orl_result orl_new_dir_refuse_used(const struct orl_log *log, const char *out) ORL_CHECK_RESULT;
// Refuses such an `out`, unless the new folder goes `over` it.
// Then, where names cannot be exchanged and an earlier run ended between two renames, this gives `out`
// its name back.
enum orl_result orl_new_dir_begin(const struct orl_log *log, const char *out, bool over,
                                  struct orl_new_dir *dir) ORL_CHECK_RESULT;
// Gives the folder its final name, which an empty folder may have. One that it goes over is removed: at
// every moment one of the two is whole under that name, except between two renames on drives that cannot
// exchange names.
enum orl_result orl_new_dir_finish(const struct orl_log *log,
                                   struct orl_new_dir *dir) ORL_CHECK_RESULT;
// Removes a folder that has not been finished, with a warning if that fails. Does nothing to one
// that has been, and to a zeroed struct.
void orl_new_dir_abort(const struct orl_log *log, struct orl_new_dir *dir);

#endif
