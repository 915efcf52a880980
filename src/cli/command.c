#include "cli/command.h"

#include <stdlib.h>
#include <string.h>

#include "cli/help.h"
#include "core/file.h"
#include "core/memory.h"

ORL_OPTION_ROWS(common_option_rows, common_options, COMMON_OPTIONS)

#define COMMAND_POINTER(name) &command_##name,
const struct command *const commands[] = {COMMANDS(COMMAND_POINTER) NULL};

const char *const command_groups[COMMAND_GROUP_COUNT] = {
    [COMMAND_MAKE] = "make", [COMMAND_LOOK] = "look", [COMMAND_MEASURE] = "measure",
    [COMMAND_FIT] = "fit", [COMMAND_JOB] = "jobs and help"};

const struct command *command_find(const char *name, bool hidden)
{
    for (size_t i = 0; commands[i]; i++)
        if (commands[i]->hidden == hidden && strcmp(commands[i]->name, name) == 0)
            return commands[i];
    return NULL;
}

const struct orl_option *no_option_rows(void)
{
    static const struct orl_option rows[] = {{0}};
    return rows;
}

int command_status(enum orl_result result)
{
    switch (result) {
    case ORL_OK:
        return 0;
    case ORL_ERR_ARGUMENT:
    case ORL_ERR_FORMAT:
    case ORL_ERR_DATA:
    case ORL_ERR_NOT_FOUND:
        return 2;
    case ORL_ERR_CANCELLED:
        return 130;
    default:
        return 1;
    }
}

static enum orl_result run(const struct orl_log *log, const struct command *command,
                           const struct common_options *common, const void *options,
                           const char *const *inputs, size_t input_count)
{
    struct terminal terminal;
    if (input_count < command->inputs_min)
        return orl_fail(log, ORL_ERR_ARGUMENT, "usage: oriel %s %s", command->name,
                        command->usage);
    enum orl_result result = orl_arguments_check(log, command->name, command->rows(), options);
    if (result != ORL_OK)
        return result;
    terminal_init(&terminal, common->verbose ? ORL_LOG_DEBUG : ORL_LOG_INFO, common->quiet);
    result = command->run(&terminal, options, common, inputs);
    terminal_finish(&terminal);
    return result;
}

int command_main(const struct command *command, int argc, const char *const *argv)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_INFO);
    struct common_options common = {COMMON_OPTIONS(ORL_OPTION_PRESET)};
    void *options = orl_array(&log, 1, command->size + 1);
    const char **inputs = orl_array(&log, command->inputs_max + 1, sizeof *inputs);
    size_t count;
    enum orl_result result = options && inputs ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        const struct orl_option_set sets[] = {
            {command->rows(), options}, {common_option_rows(), &common}, {0}};
        memcpy(options, command->presets, command->size);
        result = orl_arguments_parse(&log, command->name, sets, argc, argv, command->inputs_max,
                                   inputs, &count);
        if (result == ORL_OK && common.help)
            help_print(stdout, command);
        else if (result == ORL_OK)
            result = run(&log, command, &common, options, inputs, count);
        orl_arguments_finish(command->rows(), options);
    }
    free(options);
    free(inputs);
    return command_status(result);
}

enum orl_result command_device(const struct orl_log *log, const struct common_options *common,
                               struct orl_gpu **gpu)
{
    const struct orl_gpu_params params = {.shader_dir = common->shader_dir, .debug = common->verbose};
    return orl_gpu_create(log, &params, gpu);
}

enum orl_result command_held_out(const struct orl_log *log, int every, const struct orl_names *list,
                                 struct orl_test_block block)
{
    if ((every > 0) + (list->count > 0) + (block.end > 0) > 1)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "--test-every, --test-list and --test-block exclude each other");
    return ORL_OK;
}

enum orl_result command_is_whole(const struct orl_log *log, const char *scene, bool *whole)
{
    char *path = orl_path_join(log, scene, "scene.json");
    *whole = path && orl_path_is_file(path);
    free(path);
    return path ? ORL_OK : ORL_ERR_MEMORY;
}
