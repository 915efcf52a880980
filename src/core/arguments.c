#include "core/arguments.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    const char *found = row->name_at ? row->name_at(index) : row->words;
    for (size_t i = 0; !row->name_at && i < index && *found; i++)
        found += strcspn(found, " ") + 1;
    if (!found || !*found)
        return false;
    snprintf(name, ORL_OPTION_TEXT, "%.*s", (int)strcspn(found, " "), found);
    return true;
}

// --- parsing ---

static enum orl_result set_number(const struct orl_log *log, const struct orl_option *row,
                                  const char *text, void *field)
{
    char *end;
    bool whole = row->kind != ORL_VALUE_NUMBER;
    errno = 0;
    double value = strtod(text, &end);
    if (end == text || *end || errno || !isfinite(value) || value < row->low ||
        value > row->high || (whole && value != floor(value)))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--%s %s: must be a %snumber from %g to %g",
                        row->name, text, whole ? "whole " : "", row->low, row->high);
    if (row->kind == ORL_VALUE_INT)
        *(int *)field = (int)value;
    else if (row->kind == ORL_VALUE_SEED)
        *(uint32_t *)field = (uint32_t)value;
    else if (row->kind == ORL_VALUE_MIB)
        *(size_t *)field = (size_t)value << 20;
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
                                  const char *text, int *field)
{
    char allowed[256] = "", name[ORL_OPTION_TEXT];
    for (int i = 0; orl_option_name(row, (size_t)i, name); i++) {
        size_t used = strlen(allowed);
        if (strcmp(name, text) == 0) {
            *field = i;
            return ORL_OK;
        }
        snprintf(allowed + used, sizeof allowed - used, "%s%s", i ? ", " : "", name);
    }
    return orl_fail(log, ORL_ERR_ARGUMENT, "--%s %s: must be one of %s", row->name, text, allowed);
}

static enum orl_result set_part(const struct orl_log *log, const struct orl_option *row,
                                const char *text, struct orl_part *part)
{
    char rest;
    int k, n;
    if (sscanf(text, "%d/%d%c", &k, &n, &rest) != 2 || k < 1 || k > n)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--%s %s: not K/N with K from 1 to N", row->name,
                        text);
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
        return orl_fail(log, ORL_ERR_ARGUMENT, "--%s %s: must be A:B with A from 0 and B above A",
                        row->name, text);
    *block = told;
    return ORL_OK;
}

static enum orl_result set_value(const struct orl_log *log, const struct orl_option *row,
                                 const char *text, void *field)
{
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
        ORL_TRY(set_value(log, row, text ? text : argv[i], field_of(row, set->values)));
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

static json_t *path_text(const char *path)
{
    char *real = path ? realpath(path, NULL) : NULL;
    json_t *text = path ? json_string(real ? real : path) : NULL;
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

static json_t *number_text(const struct orl_option *row, double value)
{
    return value >= row->low && value <= row->high ? json_sprintf("%.10g", value) : NULL;
}

static json_t *choice_text(const struct orl_option *row, int value)
{
    char name[ORL_OPTION_TEXT];
    return value >= 0 && orl_option_name(row, (size_t)value, name) ? json_string(name) : NULL;
}

// As it is given on a command line; NULL: not given.
static json_t *text_of(const struct orl_option *row, const void *values)
{
    const void *field = value_of(row, values);
    const struct orl_size *size = field;
    const struct orl_part *part = field;
    const struct orl_test_block *block = field;
    switch (row->kind) {
    case ORL_VALUE_FLAG:
        return *(const bool *)field ? json_true() : NULL;
    case ORL_VALUE_PATH:
        return path_text(*(const char *const *)field);
    case ORL_VALUE_TEXT:
    case ORL_VALUE_NEEDED:
        return *(const char *const *)field ? json_string(*(const char *const *)field) : NULL;
    case ORL_VALUE_INT:
        return number_text(row, *(const int *)field);
    case ORL_VALUE_NUMBER:
        return number_text(row, *(const double *)field);
    case ORL_VALUE_SEED:
        return json_sprintf("%u", *(const uint32_t *)field);
    case ORL_VALUE_MIB:
        return number_text(row, (double)(*(const size_t *)field >> 20));
    case ORL_VALUE_SIZE:
        return size->width ? json_sprintf("%dx%d", size->width, size->height) : NULL;
    case ORL_VALUE_LIST:
        return list_text(field);
    case ORL_VALUE_CHOICE:
        return choice_text(row, *(const int *)field);
    case ORL_VALUE_PART:
        return part->count ? json_sprintf("%d/%d", part->index + 1, part->count) : NULL;
    case ORL_VALUE_BLOCK:
        return block->end ? json_sprintf("%d:%d", block->first, block->end) : NULL;
    }
    return NULL;
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

void orl_arguments_record(json_t *list, const struct orl_option *rows, const void *values,
                        const char *of)
{
    for (const struct orl_option *row = rows; row->name; row++) {
        if (of ? !find_word(row->of, of) : find_word(row->of, "-") != NULL)
            continue;
        json_t *text = text_of(row, values);
        if (text)
            json_array_append_new(list, json_sprintf("--%s", row->name));
        if (json_is_string(text))
            json_array_append(list, text);
        json_decref(text);
    }
}

static bool is_preset(const struct orl_option *row, const void *field)
{
    double value = row->kind == ORL_VALUE_NUMBER ? *(const double *)field : *(const int *)field;
    return !(value < row->preset) && !(value > row->preset);
}

// As keys of stages have it: numbers and bytes as such, else its text.
static json_t *setting_of(const struct orl_option *row, const void *values)
{
    const void *field = value_of(row, values);
    json_t *text = text_of(row, values), *number = NULL;
    if (text && row->kind == ORL_VALUE_MIB)
        number = json_integer((json_int_t)*(const size_t *)field);
    else if (text && row->kind == ORL_VALUE_NUMBER)
        number = json_real(*(const double *)field);
    else if (text && (row->kind == ORL_VALUE_INT || row->kind == ORL_VALUE_SEED))
        number = json_integer(*(const int *)field);
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
        if (!*key || (*key == '?' && orl_option_has_preset(row) && is_preset(row, value_of(row, values))))
            continue;
        json_t *value = setting_of(row, values);
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
            ORL_TRY(set_value(log, row, json_is_string(value) ? json_string_value(value) : number,
                              field_of(row, values)));
    }
    return ORL_OK;
}
