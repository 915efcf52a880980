#include "preprocess/job/exposure_list.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/text.h"

enum { LIST_MAX_BYTES = 16 << 20, FIELDS_MAX = 4 };

// Splits a line at commas, in place, and trims spaces. Counts at most FIELDS_MAX + 1 fields.
static int split(char *line, char *fields[FIELDS_MAX])
{
    int count = 0;
    for (char *at = line; at;) {
        char *comma = strchr(at, ',');
        if (comma)
            *comma = '\0';
        while (isspace((unsigned char)*at))
            at++;
        size_t length = strlen(at);
        while (length && isspace((unsigned char)at[length - 1]))
            at[--length] = '\0';
        if (count < FIELDS_MAX)
            fields[count] = at;
        count++;
        at = comma ? comma + 1 : NULL;
    }
    return count;
}

// Reads numbers such as "0.004", "1/250" and "f/8".
static bool read_number(const char *text, double *value)
{
    char *end;
    if (strncasecmp(text, "f/", 2) == 0)
        text += 2;
    *value = strtod(text, &end);
    if (end == text)
        return false;
    if (*end == '/') {
        const char *below = end + 1;
        double divisor = strtod(below, &end);
        if (end == below || !(divisor > 0))
            return false;
        *value /= divisor;
    }
    return *end == '\0' && isfinite(*value);
}

static bool read_line(char *fields[FIELDS_MAX], int count, struct orl_listed_exposure *entry)
{
    double time, aperture, iso;
    entry->absolute = count == 4;
    if (count == 2)
        return read_number(fields[1], &entry->ev) && fabs(entry->ev) <= 64;
    if (count != 4 || !read_number(fields[1], &time) || !read_number(fields[2], &aperture) ||
        !read_number(fields[3], &iso) || !(time > 0 && aperture > 0 && iso > 0))
        return false;
    entry->ev = log2(time * iso / 100 / (aperture * aperture));
    return fabs(entry->ev) <= 64;
}

// A line of titles has digits in its first field at most; a mistyped number has others.
static bool is_title(char *fields[FIELDS_MAX], int count)
{
    bool digits = strchr(fields[0], '.') != NULL; // the first field is a file name
    for (int i = 1; i < count && i < FIELDS_MAX; i++)
        digits = digits || strpbrk(fields[i], "0123456789");
    return count > 1 && !digits;
}

static enum orl_result add_line(const struct orl_log *log, const char *path, int number,
                                char *line, size_t *capacity, struct orl_exposure_list *list)
{
    char *fields[FIELDS_MAX] = {line};
    int count = split(line, fields);
    struct orl_listed_exposure entry = {0};
    if (!*fields[0] && count == 1)
        return ORL_OK;
    if (!read_line(fields, count, &entry))
        return number == 1 && is_title(fields, count)
                   ? ORL_OK
                   : orl_fail(log, ORL_ERR_FORMAT,
                              "%s: line %d: neither NAME,TIME,APERTURE,ISO nor NAME,EV", path,
                              number);
    ORL_TRY(ORL_GROW(log, list->items, *capacity, list->count));
    entry.name = orl_strdup(log, fields[0]);
    ORL_TRY_MEMORY(entry.name);
    list->items[list->count++] = entry;
    return ORL_OK;
}

enum orl_result orl_exposure_list_read(const struct orl_log *log, const char *path,
                                       struct orl_exposure_list *list)
{
    memset(list, 0, sizeof *list);
    uint8_t *data = NULL;
    size_t size, capacity = 0;
    enum orl_result result = orl_file_read(log, path, LIST_MAX_BYTES, &data, &size);
    int number = 1;
    // Spreadsheet programs write a byte order mark.
    size_t mark = result == ORL_OK ? orl_utf8_mark_length(data, size) : 0;
    for (char *line = data ? (char *)data + mark : NULL; result == ORL_OK && line; number++) {
        char *end = strchr(line, '\n');
        if (end)
            *end = '\0';
        result = add_line(log, path, number, line, &capacity, list);
        line = end ? end + 1 : NULL;
    }
    if (result == ORL_OK && !list->count)
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: no exposure in it", path);
    for (size_t i = 1; result == ORL_OK && i < list->count; i++)
        if (list->items[i].absolute != list->items[0].absolute)
            result = orl_fail(log, ORL_ERR_FORMAT,
                              "%s: %s has an exposure of another kind than %s: all must be "
                              "NAME,EV or all NAME,TIME,APERTURE,ISO", path,
                              list->items[i].name, list->items[0].name);
    free(data);
    if (result != ORL_OK)
        orl_exposure_list_finish(list);
    return result;
}

const struct orl_listed_exposure *orl_exposure_list_find(const struct orl_exposure_list *list,
                                                         const char *photo)
{
    for (size_t i = 0; i < list->count; i++)
        if (orl_path_is_named(photo, list->items[i].name))
            return &list->items[i];
    return NULL;
}

enum orl_exposure_source orl_exposure_told(const struct orl_exposure_list *list, const char *name,
                                           const char *given, const struct orl_exif *exif,
                                           double *ev)
{
    const struct orl_listed_exposure *listed = orl_exposure_list_find(list, name);
    if (!listed && given)
        listed = orl_exposure_list_find(list, given);
    if (listed) {
        *ev = listed->ev;
        return ORL_EXPOSURE_LIST;
    }
    bool comparable = list->count == 0 || list->items[0].absolute;
    return comparable && orl_exif_exposure_ev(exif, ev) ? ORL_EXPOSURE_EXIF
                                                        : ORL_EXPOSURE_UNKNOWN;
}

void orl_exposure_list_finish(struct orl_exposure_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->items[i].name);
    free(list->items);
    memset(list, 0, sizeof *list);
}
