#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/summary.h"
#include "oriel/prepare.h"

enum { INPUTS_MAX = 4096 };

struct options {
    const char *out, *masks, *exposures;
    struct arg_enum quality, sharing, matching, densifier, keep;
    int test_every, max_size, seed, max_vram_mib;
    struct orl_names test_list;
    bool resume;
};

static enum orl_result prepare(const struct terminal *terminal, const struct options *o,
                               const struct arg_common *common, const char *const *inputs,
                               size_t input_count)
{
    struct orl_prepare_params params = {
        .inputs = inputs, .input_count = input_count, .out = o->out, .test_every = o->test_every,
        .test_list = &o->test_list, .max_size = o->max_size, .masks_dir = o->masks,
        .exposures = o->exposures, .quality = (enum orl_quality)o->quality.value,
        .sharing = (enum orl_camera_sharing)o->sharing.value,
        .matching = (enum orl_matching)o->matching.value,
        .densifier = (enum orl_densifier)o->densifier.value,
        .keep = (enum orl_keep)o->keep.value,
        .resume = o->resume, .seed = (uint32_t)o->seed,
        .max_vram_bytes = (size_t)o->max_vram_mib << 20, .shader_dir = common->shader_dir};
    if (!o->out)
        return orl_fail(&terminal->log, ORL_ERR_ARGUMENT, "prepare: --out SCENE is missing");
    if (o->test_every && o->test_list.count)
        return orl_fail(&terminal->log, ORL_ERR_ARGUMENT,
                        "prepare: --test-every and --test-list exclude each other");
    return orl_prepare(&terminal->log, &params, &terminal->progress);
}

int cmd_prepare(int argc, char **argv)
{
    struct options o = {.quality = {orl_quality_names, ORL_QUALITY_STANDARD},
                        .sharing = {orl_camera_sharing_names, ORL_SHARING_AUTO},
                        .matching = {orl_matching_names, ORL_MATCHING_AUTO},
                        .densifier = {orl_densifier_names, ORL_DENSIFIER_AUTO},
                        .keep = {orl_keep_names, ORL_KEEP_MINIMAL}, .seed = 1};
    const struct arg_option options[] = {
        {"out", ARG_STRING, &o.out, "SCENE", "the scene folder to make", 0, 0},
        {"test-every", ARG_INT, &o.test_every, "N", "hold out every N-th photograph by name",
         2, 100000},
        {"test-list", ARG_LIST, &o.test_list, "A,B,..", "hold out these photographs", 0, 0},
        {"max-size", ARG_INT, &o.max_size, "PX",
         "larger side of photographs in the scene (by quality: 800, 1600, 3200)", 64, 16384},
        {"quality", ARG_ENUM, &o.quality, "NAME", "sizes and effort", 0, 0},
        {"masks", ARG_STRING, &o.masks, "DIR", "NAME.png or NAME.EXT.png; black is ignored",
         0, 0},
        {"exposures", ARG_STRING, &o.exposures, "FILE",
         "exposures in place of EXIF's: lines NAME,TIME,APERTURE,ISO or NAME,EV", 0, 0},
        {"camera-sharing", ARG_ENUM, &o.sharing, "HOW",
         "which photographs are of one camera; auto: by size and EXIF", 0, 0},
        {"matching", ARG_ENUM, &o.matching, "HOW",
         "which pairs are matched; sequential: neighbours by name; retrieval: by look", 0, 0},
        {"densifier", ARG_ENUM, &o.densifier, "NAME",
         "gl is built in, colmap needs CUDA", 0, 0},
        {"keep", ARG_ENUM, &o.keep, "WHAT",
         "minimal is what commands read; all has the stereo's maps, too", 0, 0},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory that densify keeps to", 1,
         1 << 20},
        {"resume", ARG_FLAG, &o.resume, NULL, "go on with what is in SCENE", 0, 0},
        {"seed", ARG_INT, &o.seed, "N", "of random choices", 0, 2147483647},
        {0},
    };
    const struct arg_command command = {
        .name = "prepare", .usage = "PHOTOS... --out SCENE [options]",
        .summary = "Makes a scene from photographs (files and folders of them). Needs COLMAP; "
                   "ORIEL_COLMAP\nnames its program when it is not on PATH.",
        .options = options, .positionals_min = 1, .positionals_max = INPUTS_MAX};
    const char *inputs[INPUTS_MAX];
    struct arg_common common = {0};
    struct terminal terminal;
    size_t input_count;
    int status;
    if (command_begin(&command, argc, argv, &common, &terminal, inputs, &input_count, &status)) {
        enum orl_result result = prepare(&terminal, &o, &common, inputs, input_count);
        terminal_finish(&terminal);
        if (result == ORL_OK)
            result = summary_print(&terminal.log, o.out);
        else if (result == ORL_ERR_CANCELLED)
            orl_logf(&terminal.log, ORL_LOG_WARNING, "interrupted; go on with --resume");
        status = command_status(result);
    }
    orl_names_finish(&o.test_list);
    return status;
}
