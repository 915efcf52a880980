#include "cli/command.h"

#include <stdlib.h>
#include <string.h>

#include "cli/help.h"
#include "core/file.h"
#include "core/memory.h"
#include "scene/meter.h"

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
    case ORL_ERR_UNSUPPORTED:
        return 2;
    case ORL_ERR_CANCELLED:
        return 130;
    default:
        return 1;
    }
}

static enum orl_result run(const struct orl_log *log, struct call *call, size_t input_count)
{
    const struct command *command = call->command;
    struct terminal *terminal = call->terminal;
    if (input_count < command->inputs_min)
        return orl_fail(log, ORL_ERR_ARGUMENT, "usage: oriel %s %s", command->name,
                        command->usage);
    ORL_TRY(orl_arguments_check(log, command->name, command->rows(), call->options));
    terminal_init(terminal, call->common->verbose ? ORL_LOG_DEBUG : ORL_LOG_INFO, call->common->quiet);
    call->log = &terminal->log;
    call->progress = &terminal->progress;
    enum orl_result result = command->run(call);
    orl_renderer_destroy(&call->renderer);
    orl_gpu_destroy(&call->gpu);
    orl_scene_destroy(&call->scene);
    orl_path_finish(&call->path);
    free(call->skip);
    terminal_finish(terminal);
    return result;
}

int command_main(const struct command *command, int argc, const char *const *argv)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_INFO);
    struct common_options common = {COMMON_OPTIONS(ORL_OPTION_PRESET)};
    void *options = orl_array(&log, 1, command->size + 1);
    const char **inputs = orl_array(&log, command->inputs_max + 1, sizeof *inputs);
    struct terminal terminal;
    struct call call = {.command = command, .terminal = &terminal, .options = options, .common = &common,
                        .inputs = inputs};
    size_t count;
    enum orl_result result = options && inputs ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        const struct orl_option_set sets[] = {
            {command->rows(), options}, {common_option_rows(), &common}, {0}};
        if (command->size > 0)
            memcpy(options, command->presets, command->size);
        result = orl_arguments_parse(&log, command->name, sets, argc, argv, command->inputs_max,
                                   inputs, &count);
        if (result == ORL_OK && common.help)
            help_print(stdout, command);
        else if (result == ORL_OK)
            result = run(&log, &call, count);
        orl_arguments_finish(command->rows(), options);
    }
    free(options);
    free(inputs);
    return command_status(result);
}

enum orl_result command_scene(struct call *call, const char *light)
{
    ORL_TRY(orl_scene_open(call->log, call->inputs[0], &call->scene));
    return orl_scene_set_light(call->log, call->scene, light);
}

enum orl_result command_device(struct call *call)
{
    const struct orl_gpu_params params = {.shader_dir = call->common->shader_dir,
                                          .debug = call->common->verbose};
    return orl_gpu_create(call->log, &params, &call->gpu);
}

enum orl_result command_renderer(struct call *call, const struct orl_renderer_params *params)
{
    ORL_TRY(command_device(call));
    return orl_renderer_create(call->gpu, call->scene, params, &call->renderer);
}

enum orl_result command_held_out(const struct orl_log *log, int every, const struct orl_names *list,
                                 struct orl_test_block block)
{
    if ((every > 0) + (list->count > 0) + (block.end > 0) > 1)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "--test-every, --test-list and --test-block exclude each other");
    return ORL_OK;
}

bool command_is_whole(const struct call *call)
{
    bool whole = orl_path_is_file(ORL_PATH(call->inputs[0], "scene.json"));
    if (whole)
        orl_logf(call->log, ORL_LOG_INFO, "%s: a whole scene, so there is nothing left to do", call->inputs[0]);
    return whole;
}
