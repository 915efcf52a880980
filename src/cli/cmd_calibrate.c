// oriel job calibrate: a part of a calibration, as a job beside others.

#include "cli/command.h"
#include "preprocess/calibrate/parts.h"

#define CALIBRATE_OPTIONS(ROW) \
    ROW(step, "step", CHOICE(orl_part_step, ORL_PART_STEPS, ORL_PART_FEATURES, "NAME"), \
        "features of photographs, choice of pairs, or matches") \
    ROW(part, "part", PART, "the K-th of N parts of the photographs or pairs")
COMMAND_OPTIONS(calibrate_options, CALIBRATE_OPTIONS)

static enum orl_result run_calibrate(struct call *call)
{
    const struct calibrate_options *o = call->options;
    if (!o->part.count && o->step != ORL_PART_PAIRS)
        return orl_fail(call->log, ORL_ERR_ARGUMENT, "calibrate: --part K/N is missing");
    if (o->part.count > 1 && o->step == ORL_PART_PAIRS)
        return orl_fail(call->log, ORL_ERR_ARGUMENT, "calibrate: pairs are chosen in one part");
    return orl_part_run(call->log, call->inputs[0], o->step, o->part.index,
                        o->part.count ? o->part.count : 1, call->progress);
}

const struct command command_calibrate = {
    .name = "calibrate", .group = COMMAND_JOB, .hidden = true,
    .brief = "features or matches of a part of the photographs",
    .usage = "SCENE --step NAME [--part K/N]",
    .summary = "Does a part of the calibration that oriel prepare --until collect has begun (oriel plan).\n"
               "oriel prepare --resume joins the parts and finds the cameras.",
    COMMAND_TABLE(calibrate_options), .inputs_min = 1, .inputs_max = 1, .run = run_calibrate,
};
