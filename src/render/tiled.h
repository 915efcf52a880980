// Private to src/render: the painter of method oriel, who lists the best photographs of each tile
// of the screen, so that a pixel's cost does not grow with their number.
#ifndef ORL_RENDER_TILED_H
#define ORL_RENDER_TILED_H

#include "render/method.h"

extern const struct painter orl_paint_tiled;

#endif
