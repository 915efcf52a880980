#include "core/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

char *orl_strdup(const struct orl_log *log, const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = orl_array(log, size, 1);
    if (copy)
        memcpy(copy, text, size);
    return copy;
}

char *orl_vformat(const struct orl_log *log, const char *format, va_list args)
{
    va_list again;
    va_copy(again, args);
    int length = vsnprintf(NULL, 0, format, args);
    char *text = length < 0 ? NULL : orl_array(log, (size_t)length + 1, 1);
    if (text)
        vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    return text;
}

char *orl_format(const struct orl_log *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = orl_vformat(log, format, args);
    va_end(args);
    return text;
}
