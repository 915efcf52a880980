// Output that several commands share: frames as files, and reports.
#ifndef ORL_CLI_COMMAND_OUTPUT_H
#define ORL_CLI_COMMAND_OUTPUT_H

#include "cli/args.h"
#include "render/output.h"
#include "oriel/render.h"

struct output_options {
    const char *tone_names[ORL_TONE_COUNT + 1];
    struct arg_enum tone, compression;
    double exposure_ev, white;
    bool float_color;
    struct orl_names layers;
};
// Sets the defaults. Pointers among them point into *options.
void output_options_init(struct output_options *options);
// Rows of a command's table for `o`, a struct output_options. layers_help: the allowed layers.
#define OUTPUT_OPTION_ROWS(o, layers_help)                                                       \
    {"layers", ARG_LIST, &(o)->layers, "A,B", layers_help, 0, 0},                                \
    {"exposure", ARG_NUMBER, &(o)->exposure_ev, "EV", "of .png and .mp4, in stops; default 0",   \
     -32, 32},                                                                                   \
    {"tone", ARG_ENUM, &(o)->tone, "NAME", "of .png and .mp4", 0, 0},                            \
    {"white", ARG_NUMBER, &(o)->white, "L",                                                      \
     "of reinhard: the luminance that becomes white; default 8", 1e-3, 1e6},                     \
    {"float", ARG_FLAG, &(o)->float_color, NULL, "of .exr: 32-bit colour; default: 16-bit",      \
     0, 0},                                                                                      \
    {"compression", ARG_ENUM, &(o)->compression, "NAME", "of .exr", 0, 0}
// confidence: whether the layer of this name is allowed.
enum orl_result output_choose(const struct orl_log *log, const struct output_options *options,
                              bool confidence, struct orl_frame_output *output) ORL_CHECK_RESULT;

// The row of a command's table for `name`, of which orl_scene_set_light (scene/light.h) takes the
// photograph.
#define LIGHT_OPTION_ROW(name)                                                                   \
    {"light", ARG_STRING, name, "PHOTO",                                                         \
     "show the scene in this photograph's exposure and white balance", 0, 0}

// Are exposures merged? Indices of the names of --radiance.
enum radiance_wish { RADIANCE_AUTO, RADIANCE_ON, RADIANCE_OFF };
extern const char *const radiance_names[];
#define RADIANCE_OPTION_ROW(wish)                                                                \
    {"radiance", ARG_ENUM, wish, "WHEN",                                                         \
     "merge exposures, as oriel hdr does; auto: where photographs were taken at several", 0, 0}
// auto: says so if they are.
bool radiance_chosen(const struct orl_log *log, const struct orl_scene *scene,
                     const struct arg_enum *wish);

// Writes a report to a file or, for "-", to stdout, and releases it. NULL: out of memory.
enum orl_result report_write(const struct orl_log *log, const char *path,
                             char *text) ORL_CHECK_RESULT;
// True when the report goes to stdout, so that tables must not be printed there.
bool report_on_stdout(const char *path);

#endif
