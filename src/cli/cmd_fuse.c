// oriel fuse: the points of one cluster of photographs, as a job beside others.
#include <stdlib.h>

#include "cli/commands.h"
#include "preprocess/cloud/fuse.h"

struct options {
    const char *part;
    int photographs, max_ram_mib;
    bool masks;
};

static enum orl_result run(const struct terminal *terminal, const void *options,
                           const struct arg_common *common, const char *scene)
{
    const struct options *o = options;
    const struct orl_log *log = &terminal->log;
    struct orl_fuse_params params = {.size = o->photographs, .masks = o->masks,
                                     .max_ram_bytes = (size_t)o->max_ram_mib << 20};
    bool whole = false;
    (void)common;
    if (!o->part)
        return orl_fail(log, ORL_ERR_ARGUMENT, "fuse: --part K/N is missing");
    enum orl_result result = args_part(log, o->part, &params.cluster, &params.count);
    if (result == ORL_OK)
        result = command_is_whole(log, scene, &whole);
    if (result != ORL_OK || !whole)
        return result == ORL_OK ? orl_fuse_cluster(log, scene, &params, &terminal->progress)
                                : result;
    orl_logf(log, ORL_LOG_INFO, "%s: a whole scene, so there is nothing left to do", scene);
    return ORL_OK;
}

int cmd_fuse(int argc, char **argv)
{
    struct options o = {0};
    const struct arg_option table[] = {
        {"part", ARG_STRING, &o.part, "K/N", "the K-th of N clusters", 0, 0},
        {"photographs", ARG_INT, &o.photographs, "N",
         "of a cluster, at most; default: what fits in memory, and 400", 2, 100000},
        {"masks", ARG_FLAG, &o.masks, NULL, "respect the scene's masks", 0, 0},
        {"max-ram", ARG_INT, &o.max_ram_mib, "MIB",
         "memory to keep to; default: half of what is free", 1, 1 << 24},
        {0},
    };
    const struct arg_command command = {
        "fuse", "SCENE --part K/N [options]",
        "Fuses the depth maps of one cluster of photographs (oriel plan). oriel prepare --resume\n"
        "joins the clusters.",
        table, 1, 1};
    return command_main(&command, argc, argv, run, &o);
}
