#include "scene/text_lines.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/text.h"

enum orl_result orl_text_bad(const struct orl_text_lines *l, const char *what)
{
    return orl_fail(l->log, ORL_ERR_FORMAT, "%s: line %zu (byte %zu): %s", l->path, l->number,
                    (size_t)(l->at - (char *)l->data), what);
}

enum orl_result orl_text_open(const struct orl_log *log, const char *path,
                              struct orl_text_lines *l)
{
    *l = (struct orl_text_lines){.log = log, .path = orl_strdup(log, path)};
    ORL_TRY_MEMORY(l->path);
    size_t size;
    enum orl_result result = orl_file_read(log, l->path, SIZE_MAX / 2, &l->data, &size);
    l->next = l->at = (char *)l->data;
    l->end = l->next ? l->next + size : NULL;
    if (result == ORL_OK)
        l->next += orl_utf8_mark_length(l->data, size);
    if (result == ORL_OK && orl_is_utf16(l->data, size))
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: is UTF-16: save it as UTF-8", path);
    if (result != ORL_OK)
        orl_text_close(l);
    return result;
}

void orl_text_close(struct orl_text_lines *l)
{
    free(l->path);
    free(l->data);
    memset(l, 0, sizeof *l);
}

void orl_text_back(struct orl_text_lines *l)
{
    l->again = true;
}

bool orl_text_next_raw(struct orl_text_lines *l)
{
    if (l->again) {
        l->again = false;
        l->at = l->line;
        return true;
    }
    if (l->next >= l->end)
        return false;
    char *line = l->next;
    char *stop = memchr(line, '\n', (size_t)(l->end - line));
    l->next = stop ? stop + 1 : l->end;
    stop = stop ? stop : l->end;
    while (stop > line && (stop[-1] == '\r' || stop[-1] == ' ' || stop[-1] == '\t'))
        stop--;
    *stop = '\0'; // orl_file_read adds a byte after the last one
    l->line = l->at = line;
    l->number++;
    return true;
}

bool orl_text_next(struct orl_text_lines *l)
{
    while (orl_text_next_raw(l)) {
        l->at += strspn(l->at, " \t");
        if (*l->at && *l->at != '#')
            return true;
    }
    return false;
}

bool orl_text_number(struct orl_text_lines *l, double *value)
{
    char *end;
    *value = strtod(l->at, &end);
    if (end == l->at)
        return false;
    l->at = end;
    return true;
}

bool orl_text_id(struct orl_text_lines *l, uint64_t max, uint64_t *value)
{
    char *end;
    errno = 0;
    l->at += strspn(l->at, " \t");
    if (*l->at < '0' || *l->at > '9')
        return false;
    *value = strtoull(l->at, &end, 10);
    if (errno || *value > max)
        return false;
    l->at = end;
    return true;
}

bool orl_text_numbers(struct orl_text_lines *l, double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!orl_text_number(l, &values[i]))
            return false;
    return true;
}

size_t orl_text_split(struct orl_text_lines *l, char separator, char **fields, size_t most)
{
    const char ends[2] = {separator, '\0'};
    size_t count = 0;
    char *at = l->at, *stop;
    for (; count < most; at = stop + 1) {
        at += strspn(at, " \t");
        bool quoted = *at == '"';
        fields[count++] = at += quoted;
        stop = quoted ? at + strcspn(at, "\"") : at + strcspn(at, ends);
        char *end = stop;
        stop += strcspn(stop, ends);
        bool last = !*stop;
        while (end > at && strchr(" \t", end[-1]))
            end--;
        *end = '\0';
        if (last)
            break;
    }
    return count;
}
