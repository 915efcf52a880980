// Drops isolated outliers and smooths ragged silhouettes. A pixel stays if enough pixels of its 5x5
// neighbourhood have a surface within 3 % of its depth. A hole is closed if most of its
// neighbourhood has one, with the mean depth and without a normal. One invocation handles 2x2
// pixels.
#define BLOCK_PYRAMID
#include "shared/render_blocks.h"
#include "proxy/support.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D depth_in;
layout(r32f, binding = 1) writeonly uniform image2D depth_out;
layout(rgba16f, binding = 2) writeonly uniform image2D normal;

void main()
{
    ivec2 at = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= level_size.x || at.y >= level_size.y)
        return;
    float depth[4], agree[4];
    vec2 range[4];
    for (int i = 0; i < 4; i++) {
        depth[i] = imageLoad(depth_in, at + ivec2(i & 1, i >> 1)).x;
        range[i] = support_range(depth[i]);
        agree[i] = 0.0;
    }
    depths_around around = no_depths();
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 6; x++) {
            float z = imageLoad(depth_in, clamp(at + ivec2(x, y) - 2, ivec2(0), level_size - 1)).x;
            add_depth(around, z);
            for (int i = 0; i < 4; i++) {
                ivec2 from = ivec2(x, y) - ivec2(i & 1, i >> 1);
                if (from.x >= 0 && from.x < 5 && from.y >= 0 && from.y < 5)
                    agree[i] += z >= range[i].x && z <= range[i].y ? 1.0 : 0.0;
            }
        }
    for (int i = 0; i < 4; i++) {
        bool keep = support_keeps(depth[i], agree[i], float(min_support));
        imageStore(depth_out, at + ivec2(i & 1, i >> 1), vec4(supported_depth(depth[i], keep, agree[i], around)));
        if (!keep)
            imageStore(normal, at + ivec2(i & 1, i >> 1), vec4(0.0));
    }
}
