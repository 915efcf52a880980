// Private to src/render: a frame as the mean of pictures that differ in the size of the splats and
// in their place by parts of a pixel.
//
// At silhouettes, in gaps and between surfaces that lie close together, the depth of a pixel depends
// on how large the splats are drawn and where they fall on the grid of pixels, and no choice is right
// everywhere. What the pictures agree on stays as it is, and what they differ in is averaged, as an
// accumulation buffer (Haeberli and Akeley 1990) does for what differs within a pixel.
#ifndef ORL_RENDER_RECONSTRUCTIONS_H
#define ORL_RENDER_RECONSTRUCTIONS_H

#include "render/frame/frame.h"

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

#endif
