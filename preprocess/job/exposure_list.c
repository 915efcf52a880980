#include "preprocess/job/exposure_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/text_lines.h"

enum { FIELDS_MAX = 5 }; // one more than there may be

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

static bool read_line(char *fields[FIELDS_MAX], size_t count, struct orl_listed_exposure *entry)
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
static bool is_title(char *fields[FIELDS_MAX], size_t count)
{
    bool digits = strchr(fields[0], '.') != NULL; // the first field is a file name
    for (size_t i = 1; i < count; i++)
        digits = digits || strpbrk(fields[i], "0123456789");
    return count > 1 && !digits;
}

static enum orl_result add_line(struct orl_text_lines *l, size_t *capacity, struct orl_exposure_list *list)
{
    char *fields[FIELDS_MAX];
    size_t count = orl_text_split(l, ',', fields, FIELDS_MAX);
    struct orl_listed_exposure entry = {0};
    if (!read_line(fields, count, &entry))
        return l->number == 1 && is_title(fields, count)
                   ? ORL_OK : orl_text_bad(l, "neither NAME,TIME,APERTURE,ISO nor NAME,EV");
    ORL_TRY(ORL_GROW(l->log, list->items, *capacity, list->count));
    entry.name = orl_strdup(l->log, fields[0]);
    ORL_TRY_MEMORY(entry.name);
    list->items[list->count++] = entry;
    return ORL_OK;
}

enum orl_result orl_exposure_list_read(const struct orl_log *log, const char *path,
                                       struct orl_exposure_list *list)
{
    memset(list, 0, sizeof *list);
    struct orl_text_lines l;
    size_t capacity = 0;
    enum orl_result result = orl_text_open(log, path, &l);
    while (result == ORL_OK && orl_text_next(&l))
        result = add_line(&l, &capacity, list);
    orl_text_close(&l);
    if (result == ORL_OK && !list->count)
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: no exposure in it", path);
    for (size_t i = 1; result == ORL_OK && i < list->count; i++)
        if (list->items[i].absolute != list->items[0].absolute)
            result = orl_fail(log, ORL_ERR_FORMAT,
                              "%s: %s has an exposure of another kind than %s: all must be "
                              "NAME,EV or all NAME,TIME,APERTURE,ISO", path,
                              list->items[i].name, list->items[0].name);
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

void orl_exposure_list_finish(struct orl_exposure_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->items[i].name);
    free(list->items);
    memset(list, 0, sizeof *list);
}
