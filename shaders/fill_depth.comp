// Writes guessed background depth, negative, where the proxy has none.
#define BLOCK_IMAGE
#include "include/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D filled;
layout(r32f, binding = 1) uniform image2D depth;

#define FILL_LEVEL filled
#include "include/fill.glsl"

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y || imageLoad(depth, at).r > 0.0)
        return;
    vec4 value = fill_finer(at);
    if (value.r > 0.0)
        imageStore(depth, at, vec4(-value.a / value.r));
}
