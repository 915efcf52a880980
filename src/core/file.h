// Files and folders. A file that is written appears under its final name only when it is complete.
#ifndef ORL_CORE_FILE_H
#define ORL_CORE_FILE_H

#include <stdio.h>

#include "oriel/log.h"
#include "oriel/names.h"

// ORL_PATH(DIR, FORMAT, ...): the path "DIR/<name>" of a printed name, or the name alone when DIR is "". It lives in the
// enclosing block (a branch or a loop's body without braces is a block, too) and nobody releases it. What is too long is
// cut as in struct orl_file_path. Functions that call themselves for a folder in a folder keep paths on the heap.
#define ORL_PATH(...) orl_path_print((char[ORL_PATH_SIZE]){""}, __VA_ARGS__)
const char *orl_path_print(char path[ORL_PATH_SIZE], const char *dir, const char *format, ...) ORL_PRINTF(3, 4);
// "dir/name", released with free(); NULL, logged, when memory runs out.
char *orl_path_join(const struct orl_log *log, const char *dir, const char *name);
// Length of the path without slashes at its end, for "%.*s".
int orl_path_bare(const char *path);
// The part after the last '/', pointing into `path`.
const char *orl_path_name(const char *path);
// Length of a path without the extension of its file.
size_t orl_path_stem(const char *path);
// True when `name` is the path, with or without its extension.
bool orl_path_is_named(const char *path, const char *name);
// True when a path ends in a dot and one of these words, which are separated by spaces. Case is ignored.
bool orl_path_has_extension(const char *path, const char *extensions);
bool orl_path_is_file(const char *path);
bool orl_path_is_dir(const char *path);
bool orl_path_is_pipe(const char *path);

// True when `path`, after all symbolic links are followed, is the folder or lies below it. False
// when either is missing.
bool orl_path_is_inside(const char *dir, const char *path);

// Logs what errno says of a file; returns ORL_ERR_IO.
enum orl_result orl_file_failed(const struct orl_log *log, const char *path);
// Reads a whole file. *data is owned by the caller (free) and followed by a
// zero byte that *size does not count. Files larger than max_size or than the
// available memory are refused.
enum orl_result orl_file_read(const struct orl_log *log, const char *path, size_t max_size,
                              uint8_t **data, size_t *size) ORL_CHECK_RESULT;
// Opens a stream to read from a regular file. Any other kind of file is refused at once.
enum orl_result orl_file_open(const struct orl_log *log, const char *path,
                              FILE **stream) ORL_CHECK_RESULT;

// A file that is written under a unique temporary name, then flushed to disk and renamed. Where
// `path` is a symbolic link, the link stays and its target is replaced. Standard output and special
// files (a device, a FIFO) are written directly.
struct orl_atomic_file {
    char temp[ORL_PATH_SIZE], path[ORL_PATH_SIZE]; // equal when written directly
    int fd;       // of temp
    FILE *stream; // of orl_atomic_open, owned: not for fclose
    bool direct;
};
// Creates an empty file->temp, which the writer opens by name.
enum orl_result orl_atomic_begin(const struct orl_log *log, const char *path,
                                 struct orl_atomic_file *file) ORL_CHECK_RESULT;
// The same with file->stream to write to, and to read from unless it is written directly. That a write
// failed need not be asked: the commit fails then.
enum orl_result orl_atomic_open(const struct orl_log *log, const char *path,
                                struct orl_atomic_file *file) ORL_CHECK_RESULT;
// Flushes the file and gives it its final name. On failure an earlier file of that name stays.
enum orl_result orl_atomic_commit(const struct orl_log *log,
                                  struct orl_atomic_file *file) ORL_CHECK_RESULT;
// Does nothing after a commit and to a zeroed struct, so clean-up can always call it.
void orl_atomic_abort(struct orl_atomic_file *file);
// Writes a whole file from memory in one atomic step.
enum orl_result orl_file_write(const struct orl_log *log, const char *path, const void *data,
                               size_t size) ORL_CHECK_RESULT;
// Flushes a file, or all files in a folder and below it, that another program has written, so that
// a power failure cannot leave their names without their content once they are told to be done. A
// missing path and symbolic links count as flushed.
enum orl_result orl_flush(const struct orl_log *log, const char *path) ORL_CHECK_RESULT;
// Copies a regular file, making the folders that lead to `to`.
enum orl_result orl_file_copy(const struct orl_log *log, const char *from,
                              const char *to) ORL_CHECK_RESULT;
// The name at the end of a chain of symbolic links. The file may be missing.
enum orl_result orl_path_follow(const struct orl_log *log, const char *path,
                                char target[ORL_PATH_SIZE]) ORL_CHECK_RESULT;
// "PREFIX, a random number, the name": a new temporary name beside `path`. Its 64 random bits are those of no other.
enum orl_result orl_temp_name(const struct orl_log *log, const char *prefix, const char *path,
                              char name[ORL_PATH_SIZE]) ORL_CHECK_RESULT;
// True for such a name; with a path, for one that was made for this path.
bool orl_temp_is_of(const char *name, const char *prefix, const char *path);
extern const char orl_part_prefix[]; // of what orl_dir_sweep removes when no writer holds it

// Removes temporary files and folders that killed writers left in this folder.
enum orl_result orl_dir_sweep(const struct orl_log *log, const char *dir) ORL_CHECK_RESULT;

// Creates the folder and its parents. An existing folder is accepted and swept (orl_dir_sweep).
enum orl_result orl_dir_make(const struct orl_log *log, const char *path) ORL_CHECK_RESULT;
// Creates a folder for temporary files that only this user can read: oriel-NAME-XXXXXX in TMPDIR or
// /tmp. *path is released with free().
enum orl_result orl_dir_make_temporary(const struct orl_log *log, const char *name,
                                       char **path) ORL_CHECK_RESULT;
// Creates the folder that a file is in, and its parents.
enum orl_result orl_file_make_folder(const struct orl_log *log, const char *path) ORL_CHECK_RESULT;
// Removes the folder and everything in it; a missing folder counts as success. Links are
// removed, never followed.
enum orl_result orl_dir_remove(const struct orl_log *log, const char *path) ORL_CHECK_RESULT;

// Adds the lines of a text that are not empty.
enum orl_result orl_file_read_names(const struct orl_log *log, const char *path,
                                    struct orl_names *names) ORL_CHECK_RESULT;
// Names of the folder's entries, sorted bytewise, without "." and "..".
enum orl_result orl_dir_list(const struct orl_log *log, const char *path,
                             struct orl_names *names) ORL_CHECK_RESULT;
// Does the same to all entries of a folder, in this order, until it fails.
enum orl_result orl_dir_each(const struct orl_log *log, const char *path,
                             enum orl_result (*use)(const struct orl_log *log, const char *path)) ORL_CHECK_RESULT;

// XXH3 64-bit of the file's bytes, for change detection, not for security.
enum orl_result orl_file_hash(const struct orl_log *log, const char *path,
                              uint64_t *hash) ORL_CHECK_RESULT;
// The hash as text, in the form that manifests use: "xxh3:" and 16 hexadecimal digits.
enum { ORL_CHECKSUM_SIZE = 32 };
enum orl_result orl_file_checksum(const struct orl_log *log, const char *path,
                                  char sum[ORL_CHECKSUM_SIZE]) ORL_CHECK_RESULT;

#endif
