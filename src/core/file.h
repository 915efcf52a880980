// Files and folders. Results appear under their final name only when whole.
#ifndef ORL_CORE_FILE_H
#define ORL_CORE_FILE_H

#include <stdio.h>

#include "oriel/log.h"
#include "oriel/names.h"

// "dir/name", released with free(); NULL, logged, when memory runs out.
char *orl_path_join(const struct orl_log *log, const char *dir, const char *name);
// The part after the last '/', pointing into `path`.
const char *orl_path_name(const char *path);
bool orl_path_is_file(const char *path);
bool orl_path_is_dir(const char *path);

// Is what `path` leads to, all symbolic links followed, in this folder or below it? False when
// either is not there.
bool orl_path_is_inside(const char *dir, const char *path);

// Reads a whole file. *data is owned by the caller (free) and followed by a
// zero byte that *size does not count. Files above max_size are refused, and
// those that are larger than the memory that is left.
enum orl_result orl_file_read(const struct orl_log *log, const char *path, size_t max_size,
                              uint8_t **data, size_t *size) ORL_CHECK_RESULT;
// A stream to read a regular file from; anything else is refused without waiting for it.
enum orl_result orl_file_open(const struct orl_log *log, const char *path,
                              FILE **stream) ORL_CHECK_RESULT;

// A file that is written under a temporary name of its own, then flushed to disk and renamed.
// Where `path` is a symbolic link, the file that the link names is replaced, not the link. What
// is no regular file (a device, a FIFO) and standard output are written straight.
struct orl_atomic_file {
    char *temp, *path; // owned; the same when written straight
    int fd;            // of temp
    bool direct, streamed;
};
// Writers open file->temp, which is there and empty, or ask for a stream.
enum orl_result orl_atomic_begin(const struct orl_log *log, const char *path,
                                 struct orl_atomic_file *file) ORL_CHECK_RESULT;
// A stream to write to, which the caller must close before the commit; NULL: see errno.
FILE *orl_atomic_stream(struct orl_atomic_file *file);
enum orl_result orl_atomic_commit(const struct orl_log *log,
                                  struct orl_atomic_file *file) ORL_CHECK_RESULT;
// Does nothing after a commit and to a zeroed struct, so clean-up can always call it.
void orl_atomic_abort(struct orl_atomic_file *file);
// All of these at once.
enum orl_result orl_file_write(const struct orl_log *log, const char *path, const void *data,
                               size_t size) ORL_CHECK_RESULT;
// Removes what writers that were killed left in this folder.
enum orl_result orl_dir_sweep(const struct orl_log *log, const char *dir) ORL_CHECK_RESULT;

// Creates the folder and its parents; one that exists is fine, and is swept.
enum orl_result orl_dir_make(const struct orl_log *log, const char *path) ORL_CHECK_RESULT;
// Removes the folder and all in it; one that is not there is fine. Links are
// removed, never followed.
enum orl_result orl_dir_remove(const struct orl_log *log, const char *path) ORL_CHECK_RESULT;

enum orl_result orl_dir_list(const struct orl_log *log, const char *path,
                             struct orl_names *names) ORL_CHECK_RESULT;

// XXH3 64-bit of the file's bytes, for change detection, not for security.
enum orl_result orl_file_hash(const struct orl_log *log, const char *path,
                              uint64_t *hash) ORL_CHECK_RESULT;
// The same as text, as manifests have it: "xxh3:" and 16 hexadecimal digits.
enum { ORL_CHECKSUM_SIZE = 32 };
enum orl_result orl_file_checksum(const struct orl_log *log, const char *path,
                                  char sum[ORL_CHECKSUM_SIZE]) ORL_CHECK_RESULT;

#endif
