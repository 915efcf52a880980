// Output that several commands share: frames as files, and reports.
#ifndef ORL_CLI_COMMAND_OUTPUT_H
#define ORL_CLI_COMMAND_OUTPUT_H

#include "core/arguments.h"
#include "oriel/render.h"
#include "oriel/scene.h"
#include "render/output/output.h"
#include "scene/view_choice.h"

// --- options that several commands have ---

#define VIEW_OPTIONS(ROW) \
    ROW(at, "at", TEXT("PHOTO"), "from the viewpoint of this photograph") \
    ROW(camera, "camera", TEXT("FILE"), "from the camera in FILE") \
    ROW(path, "path", TEXT("FILE"), \
        "along the cameras in FILE; \"photos\": past all photographs; \"circle\": around what they " \
        "look at") \
    ROW(frames, "frames", INT(120, 2, 100000, "N"), "of --path photos and circle") \
    ROW(size, "size", SIZE, "picture size; default: the camera's")
// The options above of a command's own `o`.
#define VIEW_OPTIONS_COPY \
    (struct orl_view_choice){o->at, o->camera, o->path, o->frames, o->size.width, o->size.height}
#define METHOD_OPTIONS(ROW) \
    ROW(method, "method", TEXT("NAME"), \
        "a method; default: the scene's, or else the first of oriel methods") \
    ROW(settings, "set", LIST("KEY=VALUE"), "change an option of the method")
#define TEXTURES_OPTION(ROW) \
    ROW(textures, "textures", CHOICE(orl_textures, ORL_TEXTURES, ORL_TEXTURES_AUTO, "KIND"), \
        "photographs on the device")
// Of the photograph that orl_scene_set_light (scene/meter.h) takes.
#define LIGHT_OPTION(ROW) \
    ROW(light, "light", TEXT("PHOTO"), \
        "show the scene in this photograph's exposure and white balance")

// --- radiance ---

#define RADIANCE_WISHES(NAME) \
    NAME(RADIANCE_AUTO, "auto") NAME(RADIANCE_ON, "on") NAME(RADIANCE_OFF, "off")
enum radiance_wish { RADIANCE_WISHES(ORL_ENUMERATOR) };
#define RADIANCE_OPTION(ROW) \
    ROW(wish, "radiance", CHOICE(radiance_wish, RADIANCE_WISHES, RADIANCE_AUTO, "WHEN"), \
        "merge exposures, as oriel hdr does; auto: where photographs were taken at several")
// auto: says so if they are.
bool radiance_chosen(const struct orl_log *log, const struct orl_scene *scene,
                     enum radiance_wish wish);

// --- files ---

const char *output_tone_name(size_t index);
// layers_help: the allowed layers.
#define OUTPUT_OPTIONS(ROW, layers_help) \
    ROW(layers, "layers", LIST("A,B"), layers_help) \
    ROW(exposure_ev, "exposure", NUMBER(0, -32, 32, "EV"), "of .png and .mp4, in stops") \
    ROW(tone, "tone", NAMED(output_tone_name, ORL_TONE_SRGB, "NAME"), "of .png and .mp4") \
    ROW(white, "white", NUMBER(8, 1e-3, 1e6, "L"), \
        "of reinhard: the luminance that becomes white") \
    ROW(fps, "fps", NUMBER(30, 1, 240, "N"), "of .mp4") \
    ROW(float_color, "float", FLAG, "of .exr: 32-bit colour; default: 16-bit") \
    ROW(compression, "compression", \
        CHOICE(orl_exr_compression, ORL_EXR_COMPRESSIONS, ORL_EXR_ZIP, "NAME"), "of .exr")
struct output_options {
    OUTPUT_OPTIONS(ORL_OPTION_MEMBER, )
};
// The options above of a command's own `o`.
#define OUTPUT_OPTIONS_COPY (struct output_options){OUTPUT_OPTIONS(ORL_OPTION_COPY, )}
// confidence: whether the layer of this name is allowed.
enum orl_result output_choose(const struct orl_log *log, struct output_options options,
                              bool confidence, struct orl_frame_output *output) ORL_CHECK_RESULT;

// Prints counts, the stages with time and memory, and left-out photographs of DIR/scene.json to stdout.
enum orl_result summary_print(const struct orl_log *log, const char *dir) ORL_CHECK_RESULT;
// Writes a report to a file or, for "-", to stdout, and releases it. NULL: out of memory, or a figure
// is no number.
enum orl_result report_write(const struct orl_log *log, const char *path,
                             json_t *report) ORL_CHECK_RESULT;
// True when the report goes to stdout, so that tables must not be printed there.
bool report_on_stdout(const char *path);

#endif
