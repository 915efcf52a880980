// What render and hdr share: which views, which photographs, how frames are written.
#ifndef ORL_CLI_VIEWS_H
#define ORL_CLI_VIEWS_H

#include "cli/args.h"
#include "render/output.h"
#include "scene/path.h"

struct view_options {
    const char *at, *camera, *path; // of which at most one is given
    struct arg_size size;
    int frames; // of --path photos
};
// At least one view. Errors name what is missing.
enum orl_result views_choose(const struct orl_log *log, const struct orl_scene *scene,
                             const struct view_options *options,
                             struct orl_path *path) ORL_CHECK_RESULT;
// One flag per photograph of the scene, released with free().
enum orl_result views_exclude(const struct orl_log *log, const struct orl_scene *scene,
                              const struct orl_names *names, bool **skip) ORL_CHECK_RESULT;

struct output_options {
    const char *tone, *compression;
    double exposure_ev, white;
    bool float_color;
    struct orl_names layers;
};
#define OUTPUT_OPTIONS_DEFAULTS .tone = "srgb", .white = 8, .compression = "zip"
// Rows of a command's table for `o`, a struct output_options; layers: what there is.
#define OUTPUT_OPTION_ROWS(o, layers_help)                                                       \
    {"layers", ARG_LIST, &(o)->layers, "A,B", layers_help, 0, 0},                                \
    {"exposure", ARG_NUMBER, &(o)->exposure_ev, "EV", "of .png and .mp4, in stops; default 0",   \
     -32, 32},                                                                                   \
    {"tone", ARG_STRING, &(o)->tone, "NAME",                                                     \
     "of .png and .mp4: srgb (default), reinhard, filmic, drago, mantiuk", 0, 0},                \
    {"white", ARG_NUMBER, &(o)->white, "L",                                                      \
     "of reinhard: the luminance that becomes white; default 8", 1e-3, 1e6},                     \
    {"float", ARG_FLAG, &(o)->float_color, NULL, "of .exr: 32-bit colour; default: 16-bit",      \
     0, 0},                                                                                      \
    {"compression", ARG_STRING, &(o)->compression, "NAME", "of .exr: zip (default) or piz", 0, 0}
// confidence: may it be asked for?
enum orl_result output_choose(const struct orl_log *log, const struct output_options *options,
                              bool confidence, struct orl_frame_output *output) ORL_CHECK_RESULT;
// A method's parameters as tuned for the scene (NULL: as they are), with KEY=VALUE settings
// applied.
enum orl_result method_choose(const struct orl_log *log, const struct orl_scene *scene,
                              const char *method,
                              const struct orl_names *settings,
                              struct orl_render_params *params) ORL_CHECK_RESULT;

#endif
