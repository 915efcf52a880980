// What programs that write an image have in common: their parameters, and one invocation for each pixel or 2x2 pixels.
#define BLOCK_IMAGE
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
