#include "core/arguments.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"

static void *field_of(const struct orl_option *row, void *values)
{
    return (char *)values + row->offset;
}

static const void *value_of(const struct orl_option *row, const void *values)
{
    return (const char *)values + row->offset;
}

bool orl_option_has_preset(const struct orl_option *row)
{
    switch (row->kind) {
    case ORL_VALUE_INT:
    case ORL_VALUE_NUMBER:
        return row->preset >= row->low && row->preset <= row->high;
    case ORL_VALUE_CHOICE:
        return row->preset >= 0;
    default:
        return row->kind == ORL_VALUE_SEED;
    }
}

bool orl_option_name(const struct orl_option *row, size_t index, char name[ORL_OPTION_TEXT])
{
    const char *found = row->words;
    memset(name, 0, ORL_OPTION_TEXT);
    if (row->slots)
        found = row->slots[index] ? *(const char *const *)row->slots[index] : NULL;
    else if (row->name_at)
        found = row->name_at(index);
    else
        for (size_t i = 0; found && i < index && *found; i++)
            found += strcspn(found, " ") + 1;
    if (!found || !*found)
        return false;
    snprintf(name, ORL_OPTION_TEXT, "%.*s", (int)strcspn(found, " ."), found);
    return true;
}

void orl_option_allowed(const struct orl_option *row, char text[ORL_OPTION_ALLOWED])
{
    char name[ORL_OPTION_TEXT];
    size_t used = 0;
    snprintf(text, ORL_OPTION_ALLOWED, "%.10g to %.10g", row->low, row->high);
    for (size_t i = 0; used < ORL_OPTION_ALLOWED && orl_option_name(row, i, name); i++)
        used += (size_t)snprintf(text + used, ORL_OPTION_ALLOWED - used, "%s%s", i ? ", " : "", name);
}

bool orl_option_equal(const struct orl_option *row, const void *a, const void *b)
{
    return memcmp(value_of(row, a), value_of(row, b), row->size) == 0;
}

// --- parsing ---

static enum orl_result refuse(const struct orl_log *log, const struct orl_option *row, const char *text,
                              const char *what, const char *allowed)
{
    return orl_fail(log, ORL_ERR_ARGUMENT, row->readers ? "%s=%s: must be %s%s" : "--%s %s: must be %s%s",
                    row->name, text, what, allowed);
}

static enum orl_result set_number(const struct orl_log *log, const struct orl_option *row,
                                  const char *text, void *field)
{
    char *end, allowed[ORL_OPTION_ALLOWED];
    bool whole = row->kind != ORL_VALUE_NUMBER && row->kind != ORL_VALUE_FLOAT;
    errno = 0;
    double value = strtod(text, &end);
    if (end == text || *end || errno || !isfinite(value) || value < row->low ||
        value > row->high || (whole && value != floor(value))) {
        orl_option_allowed(row, allowed);
        return refuse(log, row, text, whole ? "a whole number from " : "a number from ", allowed);
    }
    if (row->kind == ORL_VALUE_INT)
        *(int *)field = (int)value;
    else if (row->kind == ORL_VALUE_SEED)
        *(uint32_t *)field = (uint32_t)value;
    else if (row->kind == ORL_VALUE_MIB)
        *(size_t *)field = (size_t)value << 20;
    else if (row->kind == ORL_VALUE_FLOAT)
        *(float *)field = (float)value;
    else
        *(double *)field = value;
    return ORL_OK;
}

enum orl_result orl_size_parse(const struct orl_log *log, const char *option, const char *text,
                               struct orl_size *field)
{
    struct orl_size size;
    char rest;
    if (sscanf(text, "%dx%d%c", &size.width, &size.height, &rest) != 2 || size.width < 1 ||
        size.height < 1 || size.width > 16384 || size.height > 16384)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--%s %s: must be WxH, each from 1 to 16384",
                        option, text);
    *field = size;
    return ORL_OK;
}

static enum orl_result add_to_list(const struct orl_log *log, const struct orl_option *row,
                                   const char *text, struct orl_names *names)
{
    enum orl_result result = ORL_OK;
    while (result == ORL_OK && *text) {
        size_t length = strcspn(text, ",");
        char item[512];
        if (length >= sizeof item)
            return orl_fail(log, ORL_ERR_ARGUMENT, "--%s: an item is too long", row->name);
        memcpy(item, text, length);
        item[length] = '\0';
        if (length)
            result = orl_names_add(log, names, item);
        text += length + (text[length] == ',');
    }
    return result;
}

static enum orl_result set_choice(const struct orl_log *log, const struct orl_option *row,
                                  const char *text, void *field)
{
    char allowed[ORL_OPTION_ALLOWED], name[ORL_OPTION_TEXT];
    for (int i = 0; orl_option_name(row, (size_t)i, name); i++) {
        if (strcmp(name, text) != 0)
            continue;
        const void *value = row->kind == ORL_VALUE_WORD   ? (const void *)name
                            : row->kind == ORL_VALUE_SLOT ? (const void *)&row->slots[i]
                                                          : &i;
        memcpy(field, value, row->size);
        return ORL_OK;
    }
    orl_option_allowed(row, allowed);
    return refuse(log, row, text, "one of ", allowed);
}

static enum orl_result set_part(const struct orl_log *log, const struct orl_option *row,
                                const char *text, struct orl_part *part)
{
    char rest;
    int k, n;
    if (sscanf(text, "%d/%d%c", &k, &n, &rest) != 2 || k < 1 || k > n)
        return refuse(log, row, text, "K/N with K from 1 to N", "");
    *part = (struct orl_part){k - 1, n};
    return ORL_OK;
}

static enum orl_result set_block(const struct orl_log *log, const struct orl_option *row,
                                 const char *text, struct orl_test_block *block)
{
    char rest;
    struct orl_test_block told;
    if (sscanf(text, "%d:%d%c", &told.first, &told.end, &rest) != 2 || told.first < 0 ||
        told.end <= told.first)
        return refuse(log, row, text, "A:B with A from 0 and B above A", "");
    *block = told;
    return ORL_OK;
}

enum orl_result orl_option_set(const struct orl_log *log, const struct orl_option *row, const char *text,
                               void *values)
{
    void *field = field_of(row, values);
    switch (row->kind) {
    case ORL_VALUE_FLAG:
        *(bool *)field = true;
        return ORL_OK;
    case ORL_VALUE_TEXT:
    case ORL_VALUE_PATH:
    case ORL_VALUE_NEEDED:
        *(const char **)field = text;
        return ORL_OK;
    case ORL_VALUE_SIZE:
        return orl_size_parse(log, row->name, text, field);
    case ORL_VALUE_LIST:
        return add_to_list(log, row, text, field);
    case ORL_VALUE_CHOICE:
    case ORL_VALUE_WORD:
    case ORL_VALUE_SLOT:
        return set_choice(log, row, text, field);
    case ORL_VALUE_PART:
        return set_part(log, row, text, field);
    case ORL_VALUE_BLOCK:
        return set_block(log, row, text, field);
    default:
        return set_number(log, row, text, field);
    }
}

static const struct orl_option *find_row(const struct orl_option_set **set, const char *name,
                                      size_t length)
{
    for (; (*set)->rows; ++*set)
        for (const struct orl_option *row = (*set)->rows; row->name; row++)
            if (strlen(row->name) == length && strncmp(row->name, name, length) == 0)
                return row;
    return NULL;
}

enum orl_result orl_arguments_parse(const struct orl_log *log, const char *command,
                                  const struct orl_option_set *sets, int argc,
                                  const char *const *argv, size_t most, const char **positionals,
                                  size_t *positional_count)
{
    bool only_positionals = false;
    *positional_count = 0;
    for (int i = 0; i < argc; i++) {
        const char *arg = argv[i];
        if (only_positionals || strncmp(arg, "--", 2) != 0) {
            if (*positional_count == most)
                return orl_fail(log, ORL_ERR_ARGUMENT, "%s: unexpected argument %s", command, arg);
            positionals[(*positional_count)++] = arg;
            continue;
        }
        if (!arg[2]) {
            only_positionals = true;
            continue;
        }
        size_t length = strcspn(arg + 2, "=");
        const char *text = arg[2 + length] == '=' ? arg + 3 + length : NULL;
        const struct orl_option_set *set = sets;
        const struct orl_option *row = find_row(&set, arg + 2, length);
        if (!row)
            return orl_fail(log, ORL_ERR_ARGUMENT, "%s: unknown option %s; see oriel %s --help",
                            command, arg, command);
        bool flag = row->kind == ORL_VALUE_FLAG;
        if (flag ? text != NULL : !text && ++i >= argc)
            return orl_fail(log, ORL_ERR_ARGUMENT, "%s: --%s %s", command, row->name,
                            flag ? "takes no value" : "needs a value");
        ORL_TRY(orl_option_set(log, row, text ? text : argv[i], set->values));
    }
    return ORL_OK;
}

enum orl_result orl_arguments_check(const struct orl_log *log, const char *command,
                                  const struct orl_option *rows, const void *values)
{
    for (const struct orl_option *row = rows; row->name; row++)
        if (row->kind == ORL_VALUE_NEEDED && !*(const char *const *)value_of(row, values))
            return orl_fail(log, ORL_ERR_ARGUMENT, "%s: --%s %s is missing", command, row->name,
                            row->meta);
    return ORL_OK;
}

void orl_arguments_finish(const struct orl_option *rows, void *values)
{
    for (const struct orl_option *row = rows; row->name; row++)
        if (row->kind == ORL_VALUE_LIST)
            orl_names_finish(field_of(row, values));
}

// --- records ---

// Also of a path that is not UTF-8: it names no file then, but the option is not forgotten.
static json_t *path_text(const char *path)
{
    char *real = path ? realpath(path, NULL) : NULL;
    json_t *text = path ? orl_json_string(real ? real : path) : NULL;
    free(real);
    return text;
}

static json_t *list_text(const struct orl_names *names)
{
    json_t *text = NULL;
    for (size_t i = 0; i < names->count; i++) {
        json_t *longer = text ? json_sprintf("%s,%s", json_string_value(text), names->items[i])
                              : json_string(names->items[i]);
        json_decref(text);
        text = longer;
    }
    return text;
}

double orl_option_number(const struct orl_option *row, const void *values)
{
    const void *field = value_of(row, values);
    switch (row->kind) {
    case ORL_VALUE_SEED:
        return *(const uint32_t *)field;
    case ORL_VALUE_MIB:
        return (double)(*(const size_t *)field >> 20);
    case ORL_VALUE_NUMBER:
        return *(const double *)field;
    case ORL_VALUE_FLOAT:
        return (double)*(const float *)field;
    default:
        return *(const int *)field;
    }
}

// A float in as few digits as say what it is: 0.1, not 0.100000001.
static bool print_float(float value, char text[ORL_OPTION_TEXT])
{
    snprintf(text, ORL_OPTION_TEXT, "%.6g", (double)value);
    if (strtof(text, NULL) != value)
        snprintf(text, ORL_OPTION_TEXT, "%.9g", (double)value);
    return true;
}

static bool print_number(const struct orl_option *row, double value, char text[ORL_OPTION_TEXT])
{
    snprintf(text, ORL_OPTION_TEXT, "%.10g", value);
    return value >= row->low && value <= row->high;
}

bool orl_option_print(const struct orl_option *row, const void *values, char text[ORL_OPTION_TEXT])
{
    const void *field = value_of(row, values), *slot;
    const struct orl_size *size = field;
    const struct orl_part *part = field;
    const struct orl_test_block *block = field;
    switch (row->kind) {
    case ORL_VALUE_CHOICE:
        return *(const int *)field >= 0 && orl_option_name(row, (size_t)*(const int *)field, text);
    case ORL_VALUE_WORD:
        return snprintf(text, ORL_OPTION_TEXT, "%s", (const char *)field) > 0;
    case ORL_VALUE_SLOT:
        memcpy(&slot, field, sizeof slot);
        return snprintf(text, ORL_OPTION_TEXT, "%s", *(const char *const *)slot) > 0;
    case ORL_VALUE_SIZE:
        return snprintf(text, ORL_OPTION_TEXT, "%dx%d", size->width, size->height) > 0 && size->width;
    case ORL_VALUE_PART:
        return snprintf(text, ORL_OPTION_TEXT, "%d/%d", part->index + 1, part->count) > 0 && part->count;
    case ORL_VALUE_BLOCK:
        return snprintf(text, ORL_OPTION_TEXT, "%d:%d", block->first, block->end) > 0 && block->end;
    case ORL_VALUE_FLOAT:
        return print_float(*(const float *)field, text);
    default:
        return print_number(row, orl_option_number(row, values), text);
    }
}

// As it is given on a command line; NULL: not given.
static json_t *text_of(const struct orl_option *row, const void *values)
{
    const void *field = value_of(row, values);
    char text[ORL_OPTION_TEXT];
    switch (row->kind) {
    case ORL_VALUE_FLAG:
        return *(const bool *)field ? json_true() : NULL;
    case ORL_VALUE_PATH:
        return path_text(*(const char *const *)field);
    case ORL_VALUE_TEXT:
    case ORL_VALUE_NEEDED:
        return *(const char *const *)field ? json_string(*(const char *const *)field) : NULL;
    case ORL_VALUE_LIST:
        return list_text(field);
    default:
        return orl_option_print(row, values, text) ? json_string(text) : NULL;
    }
}

// Where the word begins in `of`, which may be NULL; it ends with a space, '=' or '?'.
static const char *find_word(const char *of, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = of; at && *at; at += strcspn(at, " "), at += *at == ' ')
        if (strncmp(at, word, length) == 0 && strcspn(at, " =?") == length)
            return at;
    return NULL;
}

void orl_arguments_record(json_t *list, const struct orl_option *rows, const void *values)
{
    for (const struct orl_option *row = rows; row->name; row++) {
        if (find_word(row->of, "-"))
            continue;
        json_t *text = text_of(row, values);
        if (text)
            json_array_append_new(list, json_sprintf("--%s", row->name));
        if (json_is_string(text))
            json_array_append(list, text);
        json_decref(text);
    }
}

static bool is_preset(const struct orl_option *row, const void *values)
{
    double value = orl_option_number(row, values);
    return !(value < row->preset) && !(value > row->preset);
}

json_t *orl_option_json(const struct orl_option *row, const void *values)
{
    json_t *text = text_of(row, values), *number = NULL;
    if (text && row->kind == ORL_VALUE_MIB)
        number = json_integer((json_int_t)*(const size_t *)value_of(row, values));
    else if (text && row->kind == ORL_VALUE_NUMBER)
        number = json_real(orl_option_number(row, values));
    else if (text && row->kind == ORL_VALUE_FLOAT)
        number = json_real(atof(json_string_value(text)));
    else if (text && (row->kind == ORL_VALUE_INT || row->kind == ORL_VALUE_SEED))
        number = json_integer((json_int_t)orl_option_number(row, values));
    else
        return text;
    json_decref(text);
    return number;
}

// The character before the name under which the stage has the value; "": it has not.
static const char *find_key(const struct orl_option *row, const char *stage)
{
    const char *word = find_word(row->of, stage);
    return word ? word + strlen(stage) : "";
}

void orl_arguments_settings(json_t *settings, const struct orl_option *rows, const void *values,
                          const char *stage)
{
    for (const struct orl_option *row = rows; row->name; row++) {
        const char *key = find_key(row, stage);
        if (!*key || (*key == '?' && orl_option_has_preset(row) && is_preset(row, values)))
            continue;
        json_t *value = orl_option_json(row, values);
        if (value)
            json_object_setn_new(settings, key + 1, strcspn(key + 1, " "), value);
    }
}

enum orl_result orl_arguments_take(const struct orl_log *log, const json_t *settings,
                                 const struct orl_option *rows, void *values, const char *stage)
{
    for (const struct orl_option *row = rows; row->name; row++) {
        const char *key = find_key(row, stage);
        const json_t *value = *key ? json_object_getn(settings, key + 1, strcspn(key + 1, " "))
                                   : NULL;
        char number[32];
        snprintf(number, sizeof number, "%.10g",
                 json_number_value(value) / (row->kind == ORL_VALUE_MIB ? 1 << 20 : 1));
        if (value)
            ORL_TRY(orl_option_set(log, row, json_is_string(value) ? json_string_value(value) : number,
                                   values));
    }
    return ORL_OK;
}
