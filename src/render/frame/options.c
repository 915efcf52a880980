// The table of options, and what the values of parameters are called.
#include <stdio.h>
#include <string.h>

#include "render/frame/method.h"
#include "shared/render_blocks.h"

#define FIELD(name) offsetof(struct orl_render_params, name)
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

bool orl_option_word(const char *list, size_t index, char word[ORL_OPTION_NAME_BYTES])
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

const char *orl_slot_name(const void *slot)
{
    return *(const char *const *)slot;
}

static const void *field_of(const struct orl_render_option *option,
                            const struct orl_render_params *params)
{
    return (const char *)params + option->offset;
}

double orl_render_option_number(const struct orl_render_option *option,
                                const struct orl_render_params *params)
{
    return (double)*(const float *)field_of(option, params);
}

void orl_render_option_print(const struct orl_render_option *option,
                             const struct orl_render_params *params, char *text, size_t size)
{
    char name[ORL_OPTION_NAME_BYTES] = "";
    if (option->kind == ORL_OPTION_NUMBER) {
        snprintf(text, size, "%.9g", orl_render_option_number(option, params));
        return;
    }
    const void *slot;
    if (option->kind == ORL_OPTION_FILE) {
        snprintf(name, sizeof name, "%s", (const char *)field_of(option, params));
    } else if (option->kind == ORL_OPTION_SLOT) {
        memcpy(&slot, field_of(option, params), sizeof slot);
        snprintf(name, sizeof name, "%s", orl_slot_name(slot));
    } else {
        orl_option_word(option->names, (size_t)*(const int *)field_of(option, params), name);
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
    for (size_t i = 0; orl_option_word(option->readers, i, condition); i++)
        if (orl_render_params_equal(params, condition))
            return true;
    return !*option->readers;
}
