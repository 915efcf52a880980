// Sums 2x2 finer pixels (Gortler 1996, pull).
#define BLOCK_IMAGE
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D fine;
layout(rgba32f, binding = 1) writeonly uniform image2D coarse;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= image_size.x || at.y >= image_size.y)
        return;
    ivec2 f = 2 * at;
    imageStore(coarse, at, imageLoad(fine, f) + imageLoad(fine, f + ivec2(1, 0)) +
                           imageLoad(fine, f + ivec2(0, 1)) + imageLoad(fine, f + ivec2(1, 1)));
}
