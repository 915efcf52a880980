// oriel synth: makes synthetic photographs with ground truth, of a monument or a moving figure.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "core/file.h"
#include "core/memory.h"
#include "datasets/figures.h"
#include "datasets/synth.h"
#include "oriel/path.h"

#define SYNTH_OPTIONS(ROW) \
    ROW(out, "out", NEEDED("DIR"), "photographs go here: a new or empty folder") \
    ROW(truth, "truth", TEXT("DIR"), \
        "cameras, depth, normals, radiance; default: DIR-truth", "monument") \
    ROW(size, "size", SIZE, "size of a photograph; default: 768x512, figures 640x480") \
    ORL_SYNTH_OPTIONS(ROW) \
    ROW(exposures, "exposures", LIST("EV,.."), \
        "exposures, taken in turn, each photograph one; default: 0", "monument") \
    ROW(path, "path", TEXT("FILE"), \
        "the monument from the views of this path, as of render --path, in place of a walk", "monument") \
    ORL_FIGURES_OPTIONS(ROW) \
    ROW(live, "live", TEXT("DIR"), "figures: plays their pictures into the folders or pipes DIR/camNN too, 25 a second", \
        "figures")
COMMAND_OPTIONS(synth_options, SYNTH_OPTIONS)

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

// The views of a path as cameras of the monument's size.
static enum orl_result read_path(const struct orl_log *log, const char *file,
                                 struct orl_synth_params *params, struct orl_path *path)
{
    struct orl_view *usual = orl_array(log, (size_t)params->count, sizeof *usual);
    struct orl_photo first = {.name = (char *)"0001.jpg"};
    struct orl_scene scene = {.dir = (char *)params->name, .photos = &first, .photo_count = 1};
    enum orl_result result = usual ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        orl_synth_views(params, usual);
        first.view = usual[0];
        result = orl_path_read(log, &scene, file, path);
    }
    if (result == ORL_OK && path->count > ORL_SYNTH_COUNT_MAX)
        result = orl_fail(log, ORL_ERR_ARGUMENT, "%s: more than %d views", file,
                          ORL_SYNTH_COUNT_MAX);
    for (size_t i = 0; result == ORL_OK && i < path->count; i++)
        path->views[i].camera =
            orl_camera_resized(&path->views[i].camera, params->width, params->height);
    params->views = path->views;
    params->count = (int)path->count;
    free(usual);
    return result;
}

static enum orl_result make_monument(struct call *call, const struct orl_synth_params *params)
{
    const struct synth_options *o = call->options;
    const char *photos = ORL_PATH("", "%.*s", orl_path_bare(o->out), o->out), *truth = o->truth;
    truth = truth ? ORL_PATH("", "%.*s", orl_path_bare(truth), truth) : ORL_PATH("", "%s-truth", photos);
    enum orl_result result = orl_synth_check(call->log, params);
    ORL_THEN(result, command_device(call));
    ORL_THEN(result, orl_synth_run(call->gpu, call->progress, params, photos, truth));
    terminal_finish(call->terminal);
    if (result == ORL_OK)
        printf("%d photographs in %s, truth in %s\n", params->count, photos, truth);
    return result;
}

// Refuses options that are another scene's.
static enum orl_result check_options(const struct orl_log *log, const struct synth_options *o,
                                     const char *name, const char *others)
{
    for (const struct orl_option *row = synth_options_rows(); row->name; row++)
        if (row->of && strcmp(row->of, others) == 0 && !orl_option_equal(row, o, &synth_options_presets))
            return orl_fail(log, ORL_ERR_ARGUMENT, "synth %s: --%s is an option of %s", name, row->name, others);
    return ORL_OK;
}

static enum orl_result make_figures(struct call *call, const struct orl_figures_params *params)
{
    const struct synth_options *o = call->options;
    const char *dir = ORL_PATH("", "%.*s", orl_path_bare(o->out), o->out);
    enum orl_result result = orl_figures_run(call->log, call->progress, params, dir);
    if (result == ORL_OK && o->live)
        result = orl_figures_play(call->log, call->progress, params, dir, o->live);
    terminal_finish(call->terminal);
    if (result == ORL_OK)
        printf("%d cameras, %d time steps in %s\n", params->cameras, params->frames, dir);
    return result;
}

static enum orl_result run_synth(struct call *call)
{
    const struct synth_options *o = call->options;
    const struct orl_log *log = call->log;
    struct orl_synth_params monument = {ORL_SYNTH_OPTIONS(ORL_OPTION_COPY) .name = call->inputs[0],
                                        .width = 768, .height = 512};
    struct orl_figures_params figures = {ORL_FIGURES_OPTIONS(ORL_OPTION_COPY) .width = 640,
                                         .height = 480};
    bool is_figures = strcmp(call->inputs[0], "figures") == 0;
    if (o->size.width) {
        monument.width = figures.width = o->size.width;
        monument.height = figures.height = o->size.height;
    }
    ORL_TRY(parse_exposures(log, &o->exposures, &monument));
    ORL_TRY(check_options(log, o, call->inputs[0], is_figures ? "monument" : "figures"));
    if (o->path) {
        ORL_TRY(orl_synth_check(log, &monument));
        ORL_TRY(read_path(log, o->path, &monument, &call->path));
    }
    return is_figures ? make_figures(call, &figures) : make_monument(call, &monument);
}

static void print_names(FILE *out)
{
    fprintf(out, "  %-12s %s\n", "figures", "a walking figure in a room, seen by fixed cameras");
    fprintf(out, "  %-12s %s\n", "monument",
            "a triumphal arch of weathered limestone on a square with houses and trees");
}

const struct command command_synth = {
    .name = "synth", .group = COMMAND_MAKE,
    .brief = "synthetic photographs with ground truth",
    .usage = "NAME --out DIR [options]",
    .summary = "Synthetic photographs with ground truth. NAME is one of:",
    .print_more = print_names,
    COMMAND_TABLE(synth_options), .inputs_min = 1, .inputs_max = 1, .run = run_synth,
};
