// oriel calibrate: a part of a calibration, as a job beside others.
#include <stdlib.h>

#include "cli/commands.h"
#include "preprocess/calibrate/parts.h"

struct options {
    const char *part;
    struct arg_enum step;
};

static enum orl_result run(const struct terminal *terminal, const void *options,
                           const struct arg_common *common, const char *scene)
{
    const struct options *o = options;
    const struct orl_log *log = &terminal->log;
    int part = 0, parts = 1;
    (void)common;
    if (!o->part && o->step.value != ORL_PART_PAIRS)
        return orl_fail(log, ORL_ERR_ARGUMENT, "calibrate: --part K/N is missing");
    enum orl_result result = o->part ? args_part(log, o->part, &part, &parts) : ORL_OK;
    if (result == ORL_OK && parts > 1 && o->step.value == ORL_PART_PAIRS)
        result = orl_fail(log, ORL_ERR_ARGUMENT, "calibrate: pairs are chosen in one part");
    return result == ORL_OK ? orl_part_run(log, scene, (enum orl_part_step)o->step.value, part,
                                           parts, &terminal->progress)
                            : result;
}

int cmd_calibrate(int argc, char **argv)
{
    struct options o = {.step = {orl_part_step_names, ORL_PART_FEATURES}};
    const struct arg_option table[] = {
        {"step", ARG_ENUM, &o.step, "NAME", "features of photographs, choice of pairs, or matches",
         0, 0},
        {"part", ARG_STRING, &o.part, "K/N", "the K-th of N parts of the photographs or pairs", 0,
         0},
        {0},
    };
    const struct arg_command command = {
        "calibrate", "SCENE --step NAME [--part K/N]",
        "Does a part of the calibration that oriel prepare --until collect has begun (oriel plan).\n"
        "oriel prepare --resume joins the parts and finds the cameras.",
        table, 1, 1};
    return command_main(&command, argc, argv, run, &o);
}
