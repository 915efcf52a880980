// Sums 2x2 finer pixels (Gortler 1996, pull).
// FAR: the values are depths and their slopes; see fill.glsl.
#define BLOCK_IMAGE
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D fine;
layout(rgba32f, binding = 1) writeonly uniform image2D coarse;

// Share of its slope that a surface keeps for a block of twice the size: the farther from the
// surface, the less its slope says.
const float SLOPE_KEPT = 0.8;

// The value of a finer pixel for the block, whose centre lies `by` finer pixels away.
vec4 fine_value(ivec2 at, vec2 by)
{
    vec4 value = imageLoad(fine, at);
#ifdef FAR
    value.x += dot(value.yz, by);
    value.yz *= 2.0 * SLOPE_KEPT;
#endif
    return value;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= image_size.x || at.y >= image_size.y)
        return;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 child = ivec2(k & 1, k >> 1);
        sum += fine_value(2 * at + child, 0.5 - vec2(child));
    }
    imageStore(coarse, at, sum);
}
