// Points drawn by the graphics pipeline: GL_POINTS of one pixel with a depth test, as point
// renderers did before compute splatting. It serves for comparison only.
#ifndef ORL_GPU_POINT_RASTER_H
#define ORL_GPU_POINT_RASTER_H

#include "oriel/gpu.h"

struct orl_point_raster;

// Uploads the points (world frame, sRGB colours) and makes targets of this size.
enum orl_result orl_point_raster_create(struct orl_gpu *gpu, const float (*positions)[3],
                                        const uint8_t (*colors)[3], size_t count, int width,
                                        int height,
                                        struct orl_point_raster **out) ORL_CHECK_RESULT;
void orl_point_raster_destroy(struct orl_point_raster **raster);
// Clears the targets and draws, as pass "GL_POINTS". The matrix is column-major and maps to GL's
// clip space, whose +y points to the picture's last row.
void orl_point_raster_draw(struct orl_point_raster *raster, const float clip_from_world[16]);
// The picture, RGBA8; alpha is 1 where a point was drawn.
const struct orl_tex *orl_point_raster_color(const struct orl_point_raster *raster);

#endif
