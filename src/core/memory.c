#include "core/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

void *orl_array(const struct orl_log *log, size_t count, size_t size)
{
    bool fits = !size || count <= SIZE_MAX / size;
    void *array = fits ? calloc(count ? count : 1, size) : NULL;
    if (!array)
        orl_logf(log, ORL_LOG_ERROR, "no memory for %zu elements of %zu bytes", count, size);
    return array;
}

enum orl_result orl_grow(const struct orl_log *log, void **array, size_t *capacity,
                         size_t needed, size_t size)
{
    if (needed <= *capacity)
        return ORL_OK;
    size_t grown = *capacity ? *capacity : 16;
    while (grown < needed) {
        if (grown > SIZE_MAX / 2)
            return orl_fail(log, ORL_ERR_MEMORY, "array of %zu elements is too large", needed);
        grown *= 2;
    }
    if (grown > SIZE_MAX / size)
        return orl_fail(log, ORL_ERR_MEMORY, "array of %zu elements is too large", needed);
    void *moved = realloc(*array, grown * size);
    if (!moved)
        return orl_fail(log, ORL_ERR_MEMORY, "no memory for %zu elements of %zu bytes", grown,
                        size);
    *array = moved;
    *capacity = grown;
    return ORL_OK;
}

enum orl_result orl_bytes_add(const struct orl_log *log, struct orl_bytes *bytes, const void *data, size_t size)
{
    ORL_TRY(orl_grow(log, (void **)&bytes->data, &bytes->capacity, bytes->size + size + 1, 1));
    if (size) // no bytes may have no address, which memcpy asks for
        memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
    bytes->data[bytes->size] = '\0';
    return ORL_OK;
}

// The number after `key` at the start of a line; UINT64_MAX when there is none.
static uint64_t read_number(const char *path, const char *key)
{
    char line[256];
    size_t length = strlen(key);
    unsigned long long value = UINT64_MAX;
    FILE *stream = fopen(path, "re");
    while (stream && fgets(line, sizeof line, stream))
        if (strncmp(line, key, length) == 0 && sscanf(line + length, "%llu", &value) == 1)
            break;
    if (stream)
        fclose(stream);
    return value;
}

static uint64_t minus(uint64_t a, uint64_t b)
{
    return a > b ? a - b : 0;
}

uint64_t orl_memory_available(void)
{
    uint64_t kib = read_number("/proc/meminfo", "MemAvailable:");
    uint64_t bytes = kib < UINT64_MAX >> 10 ? kib << 10 : UINT64_MAX;
    uint64_t most = read_number("/sys/fs/cgroup/memory.max", ""); // "max": unlimited
    uint64_t used = read_number("/sys/fs/cgroup/memory.current", "");
    uint64_t cached = read_number("/sys/fs/cgroup/memory.stat", "inactive_file ");
    if (most != UINT64_MAX && used != UINT64_MAX) {
        uint64_t left = minus(most, minus(used, cached != UINT64_MAX ? cached : 0));
        bytes = left < bytes ? left : bytes;
    }
    uint64_t left = orl_address_space_left();
    return left < bytes ? left : bytes;
}

uint64_t orl_address_space_left(void)
{
    struct rlimit limit;
    uint64_t pages = read_number("/proc/self/statm", "");
    long page = sysconf(_SC_PAGE_SIZE);
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || page <= 0 ||
        pages >= UINT64_MAX / (uint64_t)page)
        return UINT64_MAX;
    return minus(limit.rlim_cur, pages * (uint64_t)page);
}

char *orl_strdup(const struct orl_log *log, const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = orl_array(log, size, 1);
    if (copy)
        memcpy(copy, text, size);
    return copy;
}

char *orl_format(const struct orl_log *log, const char *format, ...)
{
    char *text = NULL;
    va_list args;
    va_start(args, format);
    if (vasprintf(&text, format, args) < 0) {
        orl_logf(log, ORL_LOG_ERROR, "no memory for a text");
        text = NULL;
    }
    va_end(args);
    return text;
}
