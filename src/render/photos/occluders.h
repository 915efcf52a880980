// Private to src/render: what a photograph shows before the scene and has no points.
#ifndef ORL_RENDER_OCCLUDERS_H
#define ORL_RENDER_OCCLUDERS_H

#include "render/photos/photos.h"

// Reads the photograph's occluders: U8 x1 of any size, 255 where they are. One without any gets an
// empty image.
enum orl_result orl_occluders_read(const struct orl_log *log, const struct orl_scene *scene,
                                   size_t photo, struct orl_image *mask);
// Makes the occluders of a photograph the nearest in its depth map, which has just been drawn and
// has kept[] pixels, so that it paints nothing that lies behind them.
enum orl_result orl_occluders_put(const struct frame *frame, size_t photo, const int kept[2]);

#endif
