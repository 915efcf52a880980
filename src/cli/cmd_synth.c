// oriel synth: photographs of a synthetic monument, with ground truth.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "core/memory.h"
#include "datasets/synth.h"

static enum orl_result parse_exposures(const struct orl_log *log, const struct orl_names *names,
                                       struct orl_synth_params *params)
{
    if (names->count > ORL_SYNTH_EXPOSURES_MAX)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--exposures: at most %d",
                        ORL_SYNTH_EXPOSURES_MAX);
    for (size_t i = 0; i < names->count; i++) {
        char *end;
        double ev = strtod(names->items[i], &end);
        if (end == names->items[i] || *end || !isfinite(ev))
            return orl_fail(log, ORL_ERR_ARGUMENT, "--exposures: %s is not a number",
                            names->items[i]);
        params->exposures_ev[params->exposure_count++] = ev;
    }
    return ORL_OK;
}

// `path` without slashes at its end, and `suffix`.
static char *sibling(const struct orl_log *log, const char *path, const char *suffix)
{
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/')
        length--;
    return orl_format(log, "%.*s%s", (int)length, path, suffix);
}

static enum orl_result run(struct terminal *terminal, const struct arg_common *common,
                           const struct orl_synth_params *params, const char *out,
                           const char *truth_given)
{
    struct orl_gpu *gpu = NULL;
    char *photos = sibling(&terminal->log, out, "");
    char *truth = sibling(&terminal->log, truth_given ? truth_given : out,
                          truth_given ? "" : "-truth");
    enum orl_result result = photos && truth ? orl_synth_check(&terminal->log, params)
                                             : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_gpu_create(&terminal->log,
                                &(struct orl_gpu_params){.shader_dir = common->shader_dir}, &gpu);
    if (result == ORL_OK)
        result = orl_synth_run(gpu, &terminal->progress, params, photos, truth);
    orl_gpu_destroy(&gpu);
    terminal_finish(terminal);
    if (result == ORL_OK)
        printf("%d photographs in %s, truth in %s\n", params->count, photos, truth);
    free(truth);
    free(photos);
    return result;
}

int cmd_synth(int argc, char **argv)
{
    struct orl_synth_params params = {ORL_SYNTH_DEFAULTS};
    struct arg_size size = {params.width, params.height};
    struct orl_names exposures = {0};
    const char *out = NULL, *truth = NULL;
    struct arg_enum response = {orl_synth_response_names(), 0};
    int seed = (int)params.seed;
    const struct arg_option options[] = {
        {"out", ARG_STRING, &out, "DIR", "photographs go here: a new or empty folder", 0, 0},
        {"truth", ARG_STRING, &truth, "DIR", "cameras, depth, normals, radiance (DIR-truth)", 0, 0},
        {"size", ARG_SIZE, &size, "WxH", "size of a photograph (768x512)", 0, 0},
        {"count", ARG_INT, &params.count, "N", "photographs (24)", 2, ORL_SYNTH_COUNT_MAX},
        {"seed", ARG_INT, &seed, "N", "another set of cameras and stones (1)", 0, INT32_MAX},
        {"exposures", ARG_LIST, &exposures, "EV,..",
         "exposures, taken in turn, each photograph one (0)", 0, 0},
        {"contrast", ARG_NUMBER, &params.contrast_ev, "EV",
         "deepens the shade by this many stops, and strengthens the sun, from 0 to 16 (0)", 0, 16},
        {"noise", ARG_NUMBER, &params.noise, "SIGMA",
         "sensor noise at white, linear, from 0 to 0.5 (0)", 0, 0.5},
        {"response", ARG_ENUM, &response, "NAME", "the camera's curve; film has more contrast",
         0, 0},
        {"vignette", ARG_NUMBER, &params.vignette, "SHARE",
         "light lost in the corners, from 0 to 0.9 (0)", 0, 0.9},
        {"drift", ARG_NUMBER, &params.drift_ev, "EV",
         "exposure and colour wander by up to this, untold by EXIF, from 0 to 2 (0)", 0, 2},
        {0},
    };
    char summary[512] = "Photographs of a synthetic monument with ground truth. NAME is one of:";
    for (const char *const *name = orl_synth_names(); *name; name++) {
        size_t length = strlen(summary);
        snprintf(summary + length, sizeof summary - length, "\n  %-12s %s", *name,
                 orl_synth_summary(*name));
    }
    const struct arg_command command = {"synth", "NAME --out DIR [options]", summary, options,
                                        1, 1};
    struct arg_common common = {0};
    struct terminal terminal;
    const char *positionals[1];
    size_t positional_count;
    int status;
    if (command_begin(&command, argc, argv, &common, &terminal, positionals, &positional_count,
                      &status)) {
        params.name = positionals[0];
        params.width = size.width;
        params.height = size.height;
        params.seed = (uint32_t)seed;
        enum orl_result result = parse_exposures(&terminal.log, &exposures, &params);
        params.response = (enum orl_synth_response)response.value;
        if (result == ORL_OK && !out)
            result = orl_fail(&terminal.log, ORL_ERR_ARGUMENT, "synth: --out DIR is needed");
        if (result == ORL_OK)
            result = run(&terminal, &common, &params, out, truth);
        terminal_finish(&terminal);
        status = command_status(result);
    }
    orl_names_finish(&exposures);
    return status;
}
