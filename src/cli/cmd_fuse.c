// oriel job fuse: the points of one cluster of photographs, as a job beside others.

#include "cli/command.h"
#include "preprocess/cloud/fuse.h"

#define FUSE_OPTIONS(ROW) \
    ROW(part, "part", PART, "the K-th of N clusters") \
    ROW(photographs, "photographs", INT(0, 2, 100000, "N"), \
        "of a cluster, at most; default: what fits in memory, and 400") \
    ROW(masks, "masks", FLAG, "respect the scene's masks") \
    ROW(max_ram_bytes, "max-ram", MIB(1 << 24), \
        "memory to keep to; default: half of what is free")
COMMAND_OPTIONS(fuse_options, FUSE_OPTIONS)

static enum orl_result run_fuse(struct call *call)
{
    const struct fuse_options *o = call->options;
    struct orl_fuse_params params = {.size = o->photographs, .masks = o->masks,
                                     .max_ram_bytes = o->max_ram_bytes,
                                     .cluster = o->part.index, .count = o->part.count};
    if (!o->part.count)
        return orl_fail(call->log, ORL_ERR_ARGUMENT, "fuse: --part K/N is missing");
    return command_is_whole(call) ? ORL_OK : orl_fuse_cluster(call->log, call->inputs[0], &params, call->progress);
}

const struct command command_fuse = {
    .name = "fuse", .group = COMMAND_JOB, .hidden = true,
    .brief = "points of one cluster of a scene's photographs",
    .usage = "SCENE --part K/N [options]",
    .summary = "Fuses the depth maps of one cluster of photographs (oriel plan). oriel prepare --resume\n"
               "joins the clusters.",
    COMMAND_TABLE(fuse_options), .inputs_min = 1, .inputs_max = 1, .run = run_fuse,
};
