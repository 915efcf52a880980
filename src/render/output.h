// A rendered frame as files.
#ifndef ORL_RENDER_OUTPUT_H
#define ORL_RENDER_OUTPUT_H

#include "render/render.h"

struct orl_frame_layers {
    bool depth, normal, coverage;
};

// By extension: .png writes sRGB colour, and each layer beside it as
// <stem>.<layer>.png (depth: near white, far dark, none black); .exr writes
// scene-linear colour (half), layers depth.Z, normal.X/Y/Z and coverage, and the
// camera's attributes. Written whole or not at all.
enum orl_result orl_frame_write(const struct orl_log *log, const char *path,
                                const struct orl_view *view, const struct orl_frame *frame,
                                const struct orl_frame_layers *layers) ORL_CHECK_RESULT;
// Does frame_write know the extension of `path`?
bool orl_frame_can_write(const char *path);

#endif
