// Drops outliers from the pushed depth and closes small holes. One invocation handles 2x2 pixels.
// NORMALS: what is not kept loses its normal.
#define BLOCK_PYRAMID
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D depth_in;
layout(r32f, binding = 1) writeonly uniform image2D depth_out;
#ifdef NORMALS
layout(rgba16f, binding = 2) writeonly uniform image2D normal;
#endif

float pushed(ivec2 at)
{
    return imageLoad(depth_in, clamp(at, ivec2(0), level_size - 1)).r;
}

#include "proxy/support.glsl"

void main()
{
    ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (corner.x >= level_size.x || corner.y >= level_size.y)
        return;
    float depth[4];
    int kept = support_of(corner, depth);
    for (int i = 0; i < 4; i++) { // stores come last: see gather/tiled.comp; those outside do nothing
        ivec2 at = corner + ivec2(i & 1, i >> 1);
        imageStore(depth_out, at, vec4(depth[i]));
#ifdef NORMALS
        if ((kept >> i & 1) == 0)
            imageStore(normal, at, vec4(0.0));
#endif
    }
}
