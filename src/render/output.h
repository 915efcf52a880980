// A rendered frame as files.
#ifndef ORL_RENDER_OUTPUT_H
#define ORL_RENDER_OUTPUT_H

#include "render/render.h"
#include "io/exr.h"
#include "render/tone.h"

struct orl_frame_layers {
    bool depth, normal, coverage;
    bool confidence; // of frames that have it
};

struct orl_frame_output {
    struct orl_frame_layers layers;
    struct orl_tone_params tone; // of .png
    // Of .exr:
    bool float_color; // R, G, B and normals as 32-bit floats; false: half
    enum orl_exr_compression compression;
    struct orl_exr_view_attributes attributes; // view and srgb_primaries are set here
};
#define ORL_FRAME_OUTPUT_DEFAULTS .tone = {ORL_TONE_DEFAULTS}

// By extension: .png writes tone-mapped colour, and each layer beside it as
// <stem>.<layer>.png (depth: near white, far dark, none black); .exr writes
// scene-linear colour R, G, B, layers depth.Z (float), normal.X/Y/Z (camera frame),
// coverage.Y and confidence.Y, and the camera's attributes. Written whole or not at all.
enum orl_result orl_frame_write(const struct orl_log *log, const char *path,
                                const struct orl_view *view, const struct orl_frame *frame,
                                const struct orl_frame_output *output) ORL_CHECK_RESULT;
// Does frame_write know the extension of `path`?
bool orl_frame_can_write(const char *path);

#endif
