// oriel synth: makes synthetic photographs with ground truth, of a monument or a moving figure.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "core/memory.h"
#include "datasets/figures.h"
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

// `path` without trailing slashes, followed by `suffix`.
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

// Refuses options that belong to the other set.
static enum orl_result check_options(const struct orl_log *log,
                                     const struct orl_synth_params *monument,
                                     const struct orl_figures_params *figures, bool is_figures)
{
    const struct orl_synth_params m = {ORL_SYNTH_DEFAULTS};
    const struct orl_figures_params f = {ORL_FIGURES_DEFAULTS};
    bool of_monument = monument->count != m.count || monument->seed != m.seed ||
                       monument->exposure_count || monument->contrast_ev > 0 ||
                       monument->noise > 0 || monument->response != m.response ||
                       monument->vignette > 0 || monument->drift_ev > 0 ||
                       monument->gloss > 0 || monument->bars_m > 0 || monument->plain > 0;
    bool of_figures = figures->cameras != f.cameras || figures->frames != f.frames;
    if (is_figures && of_monument)
        return orl_fail(log, ORL_ERR_ARGUMENT, "synth figures: takes --cameras, --frames and "
                        "--size; the other options are the monument's");
    if (!is_figures && of_figures)
        return orl_fail(log, ORL_ERR_ARGUMENT, "synth %s: --cameras and --frames are those of "
                        "figures", monument->name);
    return ORL_OK;
}

static enum orl_result run_figures(struct terminal *terminal,
                                   const struct orl_figures_params *params, const char *out)
{
    char *dir = sibling(&terminal->log, out, "");
    enum orl_result result = dir ? orl_figures_run(&terminal->log, &terminal->progress, params, dir)
                                 : ORL_ERR_MEMORY;
    terminal_finish(terminal);
    if (result == ORL_OK)
        printf("%d cameras, %d moments in %s\n", params->cameras, params->frames, dir);
    free(dir);
    return result;
}

int cmd_synth(int argc, char **argv)
{
    struct orl_synth_params params = {ORL_SYNTH_DEFAULTS};
    struct orl_figures_params figures = {ORL_FIGURES_DEFAULTS};
    struct arg_size size = {0, 0};
    struct orl_names exposures = {0};
    const char *out = NULL, *truth = NULL;
    struct arg_enum response = {orl_synth_response_names(), 0};
    int seed = (int)params.seed;
    const struct arg_option options[] = {
        {"out", ARG_STRING, &out, "DIR", "photographs go here: a new or empty folder", 0, 0},
        {"truth", ARG_STRING, &truth, "DIR", "cameras, depth, normals, radiance (DIR-truth)", 0, 0},
        {"size", ARG_SIZE, &size, "WxH", "size of a photograph (768x512; figures 640x480)", 0, 0},
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
        {"cameras", ARG_INT, &figures.cameras, "N", "figures: cameras around (8)", 2,
         ORL_FIGURES_CAMERAS_MAX},
        {"frames", ARG_INT, &figures.frames, "N", "figures: moments, 25 to a second (1)", 1,
         ORL_FIGURES_FRAMES_MAX},
        {"drift", ARG_NUMBER, &params.drift_ev, "EV",
         "exposure and colour wander by up to this, untold by EXIF, from 0 to 2 (0)", 0, 2},
        {"gloss", ARG_NUMBER, &params.gloss, "SHARE",
         "makes the monument shine, from 0 to 1, a mirror (0)", 0, 1},
        {"bars", ARG_NUMBER, &params.bars_m, "METRES",
         "upright bars of this diameter before the monument, from 0 to 1.5 (0)", 0, 1.5},
        {"plain", ARG_NUMBER, &params.plain, "SHARE",
         "share of the walls that has no texture, from 0 to 1 (0)", 0, 1},
        {0},
    };
    char summary[512] = "Synthetic photographs with ground truth. NAME is one of:\n"
                        "  figures      a walking figure in a room, seen by fixed cameras";
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
        bool is_figures = strcmp(positionals[0], "figures") == 0;
        if (size.width) {
            params.width = figures.width = size.width;
            params.height = figures.height = size.height;
        }
        params.seed = (uint32_t)seed;
        enum orl_result result = parse_exposures(&terminal.log, &exposures, &params);
        params.response = (enum orl_synth_response)response.value;
        if (result == ORL_OK && !out)
            result = orl_fail(&terminal.log, ORL_ERR_ARGUMENT, "synth: --out DIR is needed");
        if (result == ORL_OK)
            result = check_options(&terminal.log, &params, &figures, is_figures);
        if (result == ORL_OK)
            result = is_figures ? run_figures(&terminal, &figures, out)
                                : run(&terminal, &common, &params, out, truth);
        terminal_finish(&terminal);
        status = command_status(result);
    }
    orl_names_finish(&exposures);
    return status;
}
