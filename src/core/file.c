#include "core/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "core/memory.h"
#include "core/order.h"

const char *orl_path_print(char path[ORL_PATH_SIZE], const char *dir, const char *format, ...)
{
    size_t length = strlen(dir);
    const char *slash = length && dir[length - 1] != '/' ? "/" : "";
    int used = snprintf(path, ORL_PATH_SIZE, "%s%s", dir, slash);
    if (used < ORL_PATH_SIZE) {
        va_list args;
        va_start(args, format);
        vsnprintf(path + used, (size_t)(ORL_PATH_SIZE - used), format, args);
        va_end(args);
    }
    return path;
}

char *orl_path_join(const struct orl_log *log, const char *dir, const char *name)
{
    size_t length = strlen(dir);
    const char *slash = length && dir[length - 1] == '/' ? "" : "/";
    return orl_format(log, "%s%s%s", dir, slash, name);
}

int orl_path_bare(const char *path)
{
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/')
        length--;
    return (int)length;
}

const char *orl_path_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

size_t orl_path_stem(const char *path)
{
    const char *dot = strrchr(orl_path_name(path), '.');
    return dot ? (size_t)(dot - path) : strlen(path);
}

bool orl_path_is_named(const char *path, const char *name)
{
    size_t stem = orl_path_stem(path);
    return strcmp(path, name) == 0 || (strlen(name) == stem && strncmp(path, name, stem) == 0);
}

bool orl_path_has_extension(const char *path, const char *extensions)
{
    const char *dot = strrchr(orl_path_name(path), '.');
    size_t length = dot ? strlen(dot + 1) : 0;
    for (const char *at = extensions; length && *at; at += strspn(at, " ")) {
        size_t word = strcspn(at, " ");
        if (word == length && strncasecmp(at, dot + 1, word) == 0)
            return true;
        at += word;
    }
    return false;
}

bool orl_path_is_file(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 && S_ISREG(st.st_mode);
}

bool orl_path_is_dir(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 && S_ISDIR(st.st_mode);
}

bool orl_path_is_pipe(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 && S_ISFIFO(st.st_mode);
}

bool orl_path_is_inside(const char *dir, const char *path)
{
    char *real_dir = realpath(dir, NULL), *real_path = realpath(path, NULL);
    size_t length = real_dir ? strlen(real_dir) : 0;
    length -= length == 1; // the root "/" already ends with the separator
    bool inside = real_dir && real_path && strncmp(real_dir, real_path, length) == 0 &&
                  (real_path[length] == '/' || real_path[length] == '\0');
    free(real_dir);
    free(real_path);
    return inside;
}

enum orl_result orl_file_failed(const struct orl_log *log, const char *path)
{
    return orl_fail(log, ORL_ERR_IO, "%s: %s", path, strerror(errno));
}

enum orl_result orl_file_open(const struct orl_log *log, const char *path, FILE **stream)
{
    // O_NONBLOCK: opening a FIFO would otherwise wait for a writer, perhaps for ever.
    int fd = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    struct stat st;
    *stream = NULL;
    if (fd < 0)
        return orl_fail(log, errno == ENOENT ? ORL_ERR_NOT_FOUND : ORL_ERR_IO, "%s: %s", path,
                        strerror(errno));
    enum orl_result result = ORL_OK;
    if (fstat(fd, &st) != 0 || !S_ISREG(st.st_mode))
        result = orl_fail(log, ORL_ERR_IO, "%s: not a regular file", path);
    else if (!(*stream = fdopen(fd, "rb")))
        result = orl_fail(log, ORL_ERR_MEMORY, "%s: %s", path, strerror(errno));
    if (result != ORL_OK)
        close(fd);
    return result;
}

enum orl_result orl_file_read(const struct orl_log *log, const char *path, size_t max_size,
                              uint8_t **data, size_t *size)
{
    const size_t large = 64 << 20;
    FILE *stream;
    struct stat st;
    *data = NULL;
    *size = 0;
    ORL_TRY(orl_file_open(log, path, &stream));
    enum orl_result result = ORL_OK;
    size_t total = fstat(fileno(stream), &st) == 0 ? (size_t)st.st_size : 0;
    if (total > max_size)
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: %zu bytes, more than the %zu expected", path,
                          total, max_size);
    else if (total > large && total > orl_memory_available()) // a sparse file claims any size
        result = orl_fail(log, ORL_ERR_MEMORY, "%s: %zu bytes are more than the memory left", path,
                          total);
    else if (!(*data = orl_array(log, total + 1, 1)))
        result = ORL_ERR_MEMORY;
    else if ((*size = fread(*data, 1, total, stream)) < total)
        result = orl_fail(log, ORL_ERR_IO, "%s: read stopped at byte %zu of %zu: %s", path, *size, total,
                          ferror(stream) ? strerror(errno) : "end of file");
    fclose(stream);
    if (result != ORL_OK) {
        free(*data);
        *data = NULL;
        *size = 0;
    }
    return result;
}

enum orl_result orl_dir_make(const struct orl_log *log, const char *path)
{
    if (orl_path_is_dir(path))
        return orl_dir_sweep(NULL, path) == ORL_ERR_MEMORY
                   ? orl_fail(log, ORL_ERR_MEMORY, "%s: no memory to list it", path)
                   : ORL_OK;
    char *copy = orl_strdup(log, path);
    ORL_TRY_MEMORY(copy);
    enum orl_result result = ORL_OK;
    for (char *end = copy + 1; result == ORL_OK; end++) {
        if (*end != '/' && *end != '\0')
            continue;
        char kept = *end;
        *end = '\0';
        if (mkdir(copy, 0777) != 0 && !(errno == EEXIST && orl_path_is_dir(copy)))
            result = orl_fail(log, ORL_ERR_IO, "%s: cannot make this folder: %s", copy,
                              strerror(errno));
        *end = kept;
        if (!kept)
            break;
    }
    free(copy);
    return result;
}

enum orl_result orl_dir_make_temporary(const struct orl_log *log, const char *name, char **path)
{
    const char *parent = getenv("TMPDIR");
    *path = orl_format(log, "%s/oriel-%s-XXXXXX", parent && *parent ? parent : "/tmp", name);
    ORL_TRY_MEMORY(*path);
    if (mkdtemp(*path))
        return ORL_OK;
    enum orl_result result = orl_fail(log, ORL_ERR_IO, "%s: cannot make this folder: %s", *path,
                                      strerror(errno));
    free(*path);
    *path = NULL;
    return result;
}

enum orl_result orl_file_make_folder(const struct orl_log *log, const char *path)
{
    const char *name = orl_path_name(path);
    if (name == path)
        return ORL_OK;
    return orl_dir_make(log, ORL_PATH("", "%.*s", (int)(name - path), path));
}

enum orl_result orl_file_copy(const struct orl_log *log, const char *from, const char *to)
{
    uint8_t *data = NULL;
    size_t size = 0;
    enum orl_result result = orl_file_read(log, from, SIZE_MAX / 2, &data, &size);
    ORL_THEN(result, orl_file_make_folder(log, to));
    ORL_THEN(result, orl_file_write(log, to, data, size));
    free(data);
    return result;
}

enum orl_result orl_file_read_names(const struct orl_log *log, const char *path,
                                    struct orl_names *names)
{
    uint8_t *data = NULL;
    size_t size;
    char *rest = NULL;
    enum orl_result result = orl_file_read(log, path, (size_t)1 << 30, &data, &size);
    for (char *line = data ? strtok_r((char *)data, "\r\n", &rest) : NULL;
         result == ORL_OK && line; line = strtok_r(NULL, "\r\n", &rest))
        result = orl_names_add(log, names, line);
    free(data);
    return result;
}

enum orl_result orl_dir_list(const struct orl_log *log, const char *path, struct orl_names *names)
{
    memset(names, 0, sizeof *names);
    DIR *dir = opendir(path);
    if (!dir)
        return orl_fail(log, errno == ENOENT ? ORL_ERR_NOT_FOUND : ORL_ERR_IO, "%s: %s", path,
                        strerror(errno));
    enum orl_result result = ORL_OK;
    for (struct dirent *entry; result == ORL_OK && (entry = readdir(dir));)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            result = orl_names_add(log, names, entry->d_name);
    closedir(dir);
    if (result != ORL_OK)
        orl_names_finish(names);
    else
        orl_names_sort(names);
    return result;
}

enum orl_result orl_dir_each(const struct orl_log *log, const char *path,
                             enum orl_result (*use)(const struct orl_log *log, const char *path))
{
    struct orl_names names;
    enum orl_result result = orl_dir_list(log, path, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        char *child = orl_path_join(log, path, names.items[i]);
        result = child ? use(log, child) : ORL_ERR_MEMORY;
        free(child);
    }
    orl_names_finish(&names);
    return result;
}

enum orl_result orl_dir_remove(const struct orl_log *log, const char *path)
{
    struct stat st;
    if (lstat(path, &st) != 0)
        return errno == ENOENT ? ORL_OK : orl_file_failed(log, path);
    if (S_ISDIR(st.st_mode))
        ORL_TRY(orl_dir_each(log, path, orl_dir_remove));
    if ((S_ISDIR(st.st_mode) ? rmdir(path) : unlink(path)) != 0)
        return orl_file_failed(log, path);
    return ORL_OK;
}

enum orl_result orl_names_add(const struct orl_log *log, struct orl_names *names,
                              const char *name)
{
    ORL_TRY(ORL_GROW(log, names->items, names->capacity, names->count));
    char *copy = orl_strdup(log, name);
    ORL_TRY_MEMORY(copy);
    names->items[names->count++] = copy;
    return ORL_OK;
}

bool orl_names_contain(const struct orl_names *names, const char *name)
{
    for (size_t i = 0; i < names->count; i++)
        if (strcmp(names->items[i], name) == 0)
            return true;
    return false;
}

void orl_names_sort(struct orl_names *names)
{
    if (names->count)
        qsort(names->items, names->count, sizeof *names->items, orl_order_texts);
}

void orl_names_finish(struct orl_names *names)
{
    if (!names)
        return;
    for (size_t i = 0; i < names->count; i++)
        free(names->items[i]);
    free(names->items);
    memset(names, 0, sizeof *names);
}

enum orl_result orl_file_hash(const struct orl_log *log, const char *path, uint64_t *hash)
{
    uint8_t chunk[1 << 14];
    FILE *stream = NULL;
    *hash = 0;
    XXH3_state_t *state = XXH3_createState();
    enum orl_result result = state ? orl_file_open(log, path, &stream) : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        XXH3_64bits_reset(state);
        for (size_t got; (got = fread(chunk, 1, sizeof chunk, stream)) > 0;)
            XXH3_64bits_update(state, chunk, got);
        if (ferror(stream))
            result = orl_file_failed(log, path);
        else
            *hash = XXH3_64bits_digest(state);
        fclose(stream);
    }
    XXH3_freeState(state);
    return result;
}

enum orl_result orl_file_checksum(const struct orl_log *log, const char *path,
                                  char sum[ORL_CHECKSUM_SIZE])
{
    uint64_t hash;
    enum orl_result result = orl_file_hash(log, path, &hash);
    snprintf(sum, ORL_CHECKSUM_SIZE, "xxh3:%016" PRIx64, hash);
    return result;
}
