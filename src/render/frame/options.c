// The table of options, and the parsing of parameters from text.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/frame/method.h"
#include "shared/render_blocks.h"

#define FIELD(name) offsetof(struct orl_render_params, name)
#define TRIES_OF(...) __VA_ARGS__
#define COUNT_TRIES(...) (sizeof (double[])__VA_ARGS__ / sizeof(double))
#define SLOT_ROW(field, type, preset, read_by, text) \
    {.key = #field, .kind = ORL_OPTION_SLOT, .offset = FIELD(field), .readers = read_by, \
     .unit = "", .help = text},
#define FILE_ROW(field, preset, read_by, text) \
    {.key = #field, .kind = ORL_OPTION_FILE, .offset = FIELD(field), .readers = read_by, \
     .unit = "", .help = text},
#define CHOICE_ROW(field, type, list, preset, read_by, text) \
    {.key = #field, .kind = ORL_OPTION_CHOICE, .offset = FIELD(field), .names = list, \
     .readers = read_by, .unit = "", .help = text},
// A list of one value is ORL_NO_TRIES.
#define NUMBER_ROW(field, preset, low, high, units, read_by, list, text) \
    {.key = #field, .kind = ORL_OPTION_NUMBER, .offset = FIELD(field), .least = low, \
     .most = high, .unit = units, .readers = read_by, .help = text, .tries = list, \
     .try_count = COUNT_TRIES(list) > 1 ? (int)COUNT_TRIES(list) : 0},

const struct orl_render_option orl_render_options[] = {
    ORL_RENDER_OPTIONS(SLOT_ROW, FILE_ROW, CHOICE_ROW, NUMBER_ROW)
    {0},
};

const struct orl_render_option *orl_render_option_find(const char *key)
{
    for (const struct orl_render_option *o = orl_render_options; o->key; o++)
        if (strcmp(o->key, key) == 0)
            return o;
    return NULL;
}

// --- names ---

// The `index`-th word of a list that is separated by spaces.
static bool word_at(const char *list, size_t index, char word[ORL_OPTION_NAME_BYTES])
{
    for (; *list; list += *list == ' ') {
        size_t length = strcspn(list, " ");
        if (index-- == 0) {
            snprintf(word, ORL_OPTION_NAME_BYTES, "%.*s", (int)length, list);
            return true;
        }
        list += length;
    }
    return false;
}

// Name of the `index`-th shader file of a slot, without folder and extension; false past the last.
static bool file_at(const char *key, size_t index, char name[ORL_OPTION_NAME_BYTES])
{
    char folder[64];
    snprintf(folder, sizeof folder, "gather/%s", key);
    const char *file = orl_shader_file(folder, index);
    if (!file)
        return false;
    file += strlen(folder) + 1;
    memset(name, 0, ORL_OPTION_NAME_BYTES);
    snprintf(name, ORL_OPTION_NAME_BYTES, "%.*s", (int)strcspn(file, "."), file);
    return true;
}

bool orl_render_option_name(const struct orl_render_option *option, size_t index,
                            char name[ORL_OPTION_NAME_BYTES])
{
    const void *found;
    switch (option->kind) {
    case ORL_OPTION_CHOICE:
        return word_at(option->names, index, name);
    case ORL_OPTION_SLOT:
        found = orl_slot_at(option->key, index);
        snprintf(name, ORL_OPTION_NAME_BYTES, "%s", found ? orl_slot_name(found) : "");
        return found;
    case ORL_OPTION_FILE:
        return file_at(option->key, index, name);
    default:
        return false;
    }
}

static const void *field_of(const struct orl_render_option *option,
                            const struct orl_render_params *params)
{
    return (const char *)params + option->offset;
}

void orl_render_option_print(const struct orl_render_option *option,
                             const struct orl_render_params *params, char *text, size_t size)
{
    char name[ORL_OPTION_NAME_BYTES] = "";
    if (option->kind == ORL_OPTION_NUMBER) {
        snprintf(text, size, "%.9g", (double)*(const float *)field_of(option, params));
        return;
    }
    const void *slot;
    if (option->kind == ORL_OPTION_FILE) {
        snprintf(name, sizeof name, "%s", (const char *)field_of(option, params));
    } else if (option->kind == ORL_OPTION_SLOT) {
        memcpy(&slot, field_of(option, params), sizeof slot);
        snprintf(name, sizeof name, "%s", orl_slot_name(slot));
    } else {
        orl_render_option_name(option, (size_t)*(const int *)field_of(option, params), name);
    }
    snprintf(text, size, "%s", name);
}

bool orl_render_params_equal(const struct orl_render_params *params, const char *condition)
{
    char text[ORL_OPTION_NAME_BYTES], key[ORL_OPTION_NAME_BYTES];
    size_t length = strcspn(condition, "=");
    const char *name = condition + length + 1;
    snprintf(key, sizeof key, "%.*s", (int)length, condition);
    if (strcmp(key, "sample") == 0)
        return (strcmp(name, "radiance") == 0) == (params->sample == ORL_SAMPLE_RADIANCE);
    const struct orl_render_option *option = orl_render_option_find(key);
    if (!option || !orl_render_option_read(option, params))
        return false;
    orl_render_option_print(option, params, text, sizeof text);
    return strcmp(text, name) == 0;
}

bool orl_render_option_read(const struct orl_render_option *option,
                            const struct orl_render_params *params)
{
    char condition[ORL_OPTION_NAME_BYTES];
    for (size_t i = 0; word_at(option->readers, i, condition); i++)
        if (orl_render_params_equal(params, condition))
            return true;
    return !*option->readers;
}

// --- parameters from text ---

static void append(char *list, size_t size, const char *word)
{
    size_t used = strlen(list);
    snprintf(list + used, size - used, " %s", word);
}

static enum orl_result set_name(const struct orl_log *log, const struct orl_render_option *option,
                                const char *text, void *field)
{
    char list[256] = "", name[ORL_OPTION_NAME_BYTES];
    for (int i = 0; orl_render_option_name(option, (size_t)i, name); i++) {
        append(list, sizeof list, name);
        if (strcmp(name, text) != 0)
            continue;
        const void *slot = orl_slot_at(option->key, (size_t)i);
        if (option->kind == ORL_OPTION_FILE)
            memcpy(field, name, sizeof name);
        else if (option->kind == ORL_OPTION_SLOT)
            memcpy(field, &slot, sizeof slot);
        else
            memcpy(field, &i, sizeof i); // enums of this struct are ints
        return ORL_OK;
    }
    return orl_fail(log, ORL_ERR_ARGUMENT, "%s=%s: must be one of%s", option->key, text, list);
}

static enum orl_result set_value(const struct orl_log *log,
                                 const struct orl_render_option *option, const char *text,
                                 struct orl_render_params *params)
{
    void *field = (char *)params + option->offset;
    if (option->kind != ORL_OPTION_NUMBER)
        return set_name(log, option, text, field);
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !(value >= option->least && value <= option->most))
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s=%s: must be a number from %g to %g",
                        option->key, text, option->least, option->most);
    *(float *)field = (float)value;
    return ORL_OK;
}

static enum orl_result find_key(const struct orl_log *log, const char *assignment,
                                const struct orl_render_option **option)
{
    char list[512] = "";
    size_t length = strcspn(assignment, "=");
    if (assignment[length] != '=')
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s: must be KEY=VALUE", assignment);
    for (*option = orl_render_options; (*option)->key; (*option)++) {
        if (strlen((*option)->key) == length && strncmp((*option)->key, assignment, length) == 0)
            return ORL_OK;
        append(list, sizeof list, (*option)->key);
    }
    return orl_fail(log, ORL_ERR_ARGUMENT, "option %.*s is not known; there are:%s", (int)length,
                    assignment, list);
}

enum orl_result orl_render_params_assign(const struct orl_log *log,
                                         struct orl_render_params *params,
                                         const char *const *assignments, size_t count)
{
    const struct orl_render_option *option;
    struct orl_render_params changed = *params;
    for (size_t i = 0; i < count; i++) {
        enum orl_result result = find_key(log, assignments[i], &option);
        ORL_THEN(result, set_value(log, option, assignments[i] + strlen(option->key) + 1, &changed));
        if (result != ORL_OK)
            return result;
    }
    // Checked after all assignments, since a later one may choose what reads an option.
    for (size_t i = 0; i < count; i++) {
        enum orl_result result = find_key(log, assignments[i], &option);
        if (result != ORL_OK)
            return result;
        if (!orl_render_option_read(option, &changed))
            return orl_fail(log, ORL_ERR_ARGUMENT,
                            "%s: this method does not read it; it belongs to: %s", assignments[i],
                            option->readers);
    }
    enum orl_result result = orl_render_params_check(log, &changed);
    if (result == ORL_OK)
        *params = changed;
    return result;
}

enum orl_result orl_render_params_set(const struct orl_log *log, struct orl_render_params *params,
                                      const char *assignment)
{
    return orl_render_params_assign(log, params, &assignment, 1);
}
