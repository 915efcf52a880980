// Writes rendered frames as files.
#ifndef ORL_RENDER_OUTPUT_H
#define ORL_RENDER_OUTPUT_H

#include "oriel/render.h"
#include "io/exr.h"
#include "render/output/tone.h"

struct orl_frame_layers {
    bool depth, normal, coverage;
    bool confidence; // only if the frame has it
};

struct orl_frame_output {
    struct orl_frame_layers layers;
    struct orl_tone_params tone; // for .png
    // For .exr:
    bool float_color; // R, G, B and normals as 32-bit floats; false: as half floats
    enum orl_exr_compression compression;
    struct orl_exr_view_attributes attributes; // orl_frame_write sets view and srgb_primaries
};
#define ORL_FRAME_OUTPUT_DEFAULTS .tone = {ORL_TONE_DEFAULTS}

// Writes a frame in the format of the extension. .png: tone-mapped colour, and each layer beside it
// as <stem>.<layer>.png (depth: near is white, far is dark, none is black). .exr: scene-linear
// colour R, G, B, the layers depth.Z (float), normal.X/Y/Z (camera frame), coverage.Y and
// confidence.Y, and the camera's attributes. A file is written completely or not at all.
enum orl_result orl_frame_write(const struct orl_log *log, const char *path,
                                const struct orl_view *view, const struct orl_frame *frame,
                                const struct orl_frame_output *output) ORL_CHECK_RESULT;
// True if orl_frame_write supports the extension of `path`.
bool orl_frame_can_write(const char *path);

#endif
