#include "cli/args.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool parse_number(const char *text, double *value)
{
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    return end != text && *end == '\0' && errno == 0 && isfinite(*value);
}

static enum orl_result set_number(const struct orl_log *log, const struct arg_option *option,
                                  const char *text)
{
    double value;
    bool whole = option->type == ARG_INT;
    if (!parse_number(text, &value) || value < option->min || value > option->max ||
        (whole && value != floor(value)))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--%s %s: must be a %snumber from %g to %g",
                        option->name, text, whole ? "whole " : "", option->min, option->max);
    if (whole)
        *(int *)option->value = (int)value;
    else
        *(double *)option->value = value;
    return ORL_OK;
}

static enum orl_result set_size(const struct orl_log *log, const struct arg_option *option,
                                const char *text)
{
    struct arg_size size;
    char rest;
    if (sscanf(text, "%dx%d%c", &size.width, &size.height, &rest) != 2 || size.width < 1 ||
        size.height < 1 || size.width > 16384 || size.height > 16384)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--%s %s: must be WxH, each from 1 to 16384",
                        option->name, text);
    *(struct arg_size *)option->value = size;
    return ORL_OK;
}

static enum orl_result add_to_list(const struct orl_log *log, const struct arg_option *option,
                                   const char *text)
{
    enum orl_result result = ORL_OK;
    while (result == ORL_OK && *text) {
        size_t length = strcspn(text, ",");
        char item[512];
        if (length >= sizeof item)
            return orl_fail(log, ORL_ERR_ARGUMENT, "--%s: an item is too long", option->name);
        memcpy(item, text, length);
        item[length] = '\0';
        if (length)
            result = orl_names_add(log, option->value, item);
        text += length + (text[length] == ',');
    }
    return result;
}

// Writes the names, separated by commas.
static void list_names(const struct arg_enum *e, char text[256])
{
    text[0] = '\0';
    for (int i = 0; e->names[i]; i++) {
        size_t used = strlen(text);
        snprintf(text + used, 256 - used, "%s%s", i ? ", " : "", e->names[i]);
    }
}

static enum orl_result set_enum(const struct orl_log *log, const struct arg_option *option,
                                const char *text)
{
    struct arg_enum *e = option->value;
    char allowed[256];
    for (int i = 0; e->names[i]; i++) {
        if (strcmp(e->names[i], text) == 0) {
            e->value = i;
            return ORL_OK;
        }
    }
    list_names(e, allowed);
    return orl_fail(log, ORL_ERR_ARGUMENT, "--%s %s: must be one of %s", option->name, text,
                    allowed);
}

static enum orl_result set_option(const struct orl_log *log, const struct arg_option *option,
                                  const char *text)
{
    switch (option->type) {
    case ARG_FLAG:
        *(bool *)option->value = true;
        return ORL_OK;
    case ARG_STRING:
        *(const char **)option->value = text;
        return ORL_OK;
    case ARG_INT:
    case ARG_NUMBER:
        return set_number(log, option, text);
    case ARG_SIZE:
        return set_size(log, option, text);
    case ARG_LIST:
        return add_to_list(log, option, text);
    case ARG_ENUM:
        return set_enum(log, option, text);
    }
    return ORL_ERR_ARGUMENT;
}

static const struct arg_option *find_option(const struct arg_option *options, const char *name,
                                            size_t length)
{
    for (; options->name; options++)
        if (strlen(options->name) == length && strncmp(options->name, name, length) == 0)
            return options;
    return NULL;
}

static void print_options(const struct arg_option *options)
{
    for (; options->name; options++) {
        char left[64], allowed[256] = "";
        const struct arg_enum *e = options->type == ARG_ENUM ? options->value : NULL;
        if (e)
            list_names(e, allowed);
        snprintf(left, sizeof left, "--%s%s%s", options->name, options->meta ? " " : "",
                 options->meta ? options->meta : "");
        printf("  %-28s %s%s%s", left, options->help, e ? ": " : "", allowed);
        if (e && e->value >= 0)
            printf("; default %s", e->names[e->value]);
        printf("\n");
    }
}

static void print_help(const struct arg_command *command, const struct arg_option *common)
{
    printf("usage: oriel %s %s\n\n%s\n\noptions:\n", command->name, command->usage,
           command->summary);
    print_options(command->options);
    print_options(common);
}

enum orl_result args_parse(const struct orl_log *log, const struct arg_command *command, int argc,
                           char **argv, struct arg_common *common, const char **positionals,
                           size_t *positional_count)
{
    const struct arg_option common_options[] = {
        {"help", ARG_FLAG, &common->help, NULL, "show this help", 0, 0},
        {"quiet", ARG_FLAG, &common->quiet, NULL, "errors and results only", 0, 0},
        {"verbose", ARG_FLAG, &common->verbose, NULL, "say more", 0, 0},
        {"shader-dir", ARG_STRING, &common->shader_dir, "DIR",
         "read shaders from DIR (for development)", 0, 0},
        {0},
    };
    *positional_count = 0;
    bool only_positionals = false;
    for (int i = 0; i < argc; i++) {
        const char *arg = argv[i];
        if (only_positionals || strncmp(arg, "--", 2) != 0) {
            if (*positional_count == command->positionals_max)
                return orl_fail(log, ORL_ERR_ARGUMENT, "%s: unexpected argument %s",
                                command->name, arg);
            positionals[(*positional_count)++] = arg;
            continue;
        }
        if (!arg[2]) {
            only_positionals = true;
            continue;
        }
        size_t length = strcspn(arg + 2, "=");
        const char *text = arg[2 + length] == '=' ? arg + 3 + length : NULL;
        const struct arg_option *option = find_option(command->options, arg + 2, length);
        if (!option)
            option = find_option(common_options, arg + 2, length);
        if (!option)
            return orl_fail(log, ORL_ERR_ARGUMENT, "%s: unknown option %s; see oriel %s --help",
                            command->name, arg, command->name);
        if (option->type == ARG_FLAG ? text != NULL : !text && ++i >= argc)
            return orl_fail(log, ORL_ERR_ARGUMENT, "%s: --%s %s", command->name, option->name,
                            option->type == ARG_FLAG ? "takes no value" : "needs a value");
        enum orl_result result = set_option(log, option, text ? text : argv[i]);
        if (result != ORL_OK)
            return result;
    }
    if (common->help) {
        print_help(command, common_options);
        return ORL_OK;
    }
    if (*positional_count < command->positionals_min)
        return orl_fail(log, ORL_ERR_ARGUMENT, "usage: oriel %s %s", command->name,
                        command->usage);
    return ORL_OK;
}

enum orl_result args_held_out(const struct orl_log *log, int every, const struct orl_names *list,
                              const char *text, struct orl_test_block *block)
{
    char end;
    if ((every > 0) + (list->count > 0) + (text != NULL) > 1)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "--test-every, --test-list and --test-block exclude each other");
    if (text && (sscanf(text, "%d:%d%c", &block->first, &block->end, &end) != 2 ||
                 block->first < 0 || block->end <= block->first))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--test-block %s: must be A:B with A from 0 and B "
                        "above A", text);
    return ORL_OK;
}

enum orl_result args_part(const struct orl_log *log, const char *text, int *index, int *count)
{
    char end;
    if (sscanf(text, "%d/%d%c", index, count, &end) != 2 || *index < 1 || *index > *count)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--part %s: not K/N with K from 1 to N", text);
    --*index;
    return ORL_OK;
}
