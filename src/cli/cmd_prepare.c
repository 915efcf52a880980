// oriel prepare: makes a scene from photographs.

#include "cli/command.h"
#include "cli/command_output.h"
#include "oriel/prepare.h"

static enum orl_result run_prepare(struct call *call)
{
    const struct orl_log *log = call->log;
    struct orl_prepare_params params = *(const struct orl_prepare_params *)call->options;
    params.inputs = call->inputs;
    params.shader_dir = call->common->shader_dir;
    while (call->inputs[params.input_count])
        params.input_count++;
    if (params.fps > 0 && params.frames)
        return orl_fail(log, ORL_ERR_ARGUMENT, "prepare: --fps and --frames exclude each other");
    enum orl_result result =
        command_held_out(log, params.test_every, &params.test_list, params.test_block);
    ORL_THEN(result, orl_prepare(log, &params, call->progress));
    terminal_finish(call->terminal);
    if (result == ORL_OK && params.until == ORL_UNTIL_END)
        result = summary_print(log, params.out);
    else if (result == ORL_ERR_CANCELLED)
        orl_logf(log, ORL_LOG_WARNING, "interrupted; go on with --resume");
    return result;
}

static const struct orl_prepare_params presets = {ORL_PREPARE_DEFAULTS};

const struct command command_prepare = {
    .name = "prepare", .group = COMMAND_MAKE,
    .brief = "make a scene from photographs",
    .usage = "PHOTOS... --out SCENE [options]",
    .summary = "Makes a scene from photographs and videos (files and folders of them). Needs COLMAP;\n"
               "ORIEL_COLMAP names its program when it is not on PATH.",
    .rows = orl_prepare_options, .presets = &presets, .size = sizeof presets, .inputs_min = 1,
    .inputs_max = 1 << 20, .run = run_prepare,
};
