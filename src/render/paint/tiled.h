// Private to src/render: the painter of method oriel. It lists the best photographs of each tile of
// the screen, so that the cost of a pixel does not grow with the number of photographs.
#ifndef ORL_RENDER_TILED_H
#define ORL_RENDER_TILED_H

#include "render/frame/method.h"

extern const struct orl_painter orl_paint_tiled;

#endif
