// Private to src/render: the frame as a whole.
#ifndef ORL_RENDER_INTERNAL_H
#define ORL_RENDER_INTERNAL_H

#include "render/frame/frame.h"

// --- compose.c: the passes between the painter and the finished picture ---

enum orl_result orl_compose(const struct frame *frame) ORL_CHECK_RESULT;

// --- reconstructions.c ---

// How many pictures this frame is the mean of.
int orl_reconstruction_count(const struct frame *frame);
// Changes the frame's parameters and camera to those that the surface of the index-th picture is
// drawn with. The first picture has the frame's own. Depth maps of photographs are always drawn
// with the frame's.
void orl_reconstruction_vary(int index, int count, struct orl_render_params *params,
                             struct orl_camera *camera);
// Adds the finished picture to the mean (RGBA32F), in square roots of light. After the last one, the
// picture is the mean. Coverage is that of the first.
void orl_reconstruction_add(const struct frame *frame, struct orl_tex *mean, int index, int count);

// --- read_back.c ---

// Reads all layers except params->leave_out. `staging` is reused for frames of the same kind.
enum orl_result orl_read_back(const struct frame *frame, struct orl_image *staging,
                              struct orl_frame *out);

#endif
