// Fills pixels that know nothing from the coarser level, bilinearly (Gortler 1996, push).
#define BLOCK_IMAGE
#include "include/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) uniform image2D fine;
layout(rgba32f, binding = 1) readonly uniform image2D coarse;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y || imageLoad(fine, at).a > 0.0)
        return;
    ivec2 parent = at / 2, side = 2 * (at & 1) - 1, last = imageSize(coarse) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 step = ivec2(i & 1, i >> 1);
        ivec2 from = clamp(parent + side * step, ivec2(0), last);
        vec4 value = imageLoad(coarse, from);
        float share = (step.x == 0 ? 0.75 : 0.25) * (step.y == 0 ? 0.75 : 0.25);
        sum += share * value;
    }
    if (sum.a > 0.0)
        imageStore(fine, at, sum);
}
