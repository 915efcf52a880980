// Drops isolated outliers and smooths ragged silhouettes. A pixel stays if enough pixels of its 5x5
// neighbourhood have a surface within 3 % of its depth. A hole is closed if most of its
// neighbourhood has one, with the mean depth and without a normal. One invocation handles 2x2
// pixels.
#define BLOCK_PYRAMID
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D depth_in;
layout(r32f, binding = 1) writeonly uniform image2D depth_out;
layout(rgba16f, binding = 2) writeonly uniform image2D normal;

const float MOST = 13.0;

void main()
{
    ivec2 at = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= level_size.x || at.y >= level_size.y)
        return;
    // Range of depths that agree with each of the four pixels. For a hole, every depth agrees.
    float depth[4], least[4], most[4], agree[4];
    // Statistics of the 6x6 pixels around all four; separate ones for each would double the cost.
    float known = 0.0, sum = 0.0, near = 1e30, far = 0.0;
    for (int i = 0; i < 4; i++) {
        depth[i] = imageLoad(depth_in, at + ivec2(i & 1, i >> 1)).x;
        least[i] = depth[i] > 0.0 ? 0.97 * depth[i] : 1e-30;
        most[i] = depth[i] > 0.0 ? 1.03 * depth[i] : 1e30;
        agree[i] = 0.0;
    }
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 6; x++) {
            float z = imageLoad(depth_in, clamp(at + ivec2(x, y) - 2, ivec2(0), level_size - 1)).x;
            known += z > 0.0 ? 1.0 : 0.0;
            sum += z;
            near = min(near, z > 0.0 ? z : near);
            far = max(far, z);
            for (int i = 0; i < 4; i++) {
                ivec2 from = ivec2(x, y) - ivec2(i & 1, i >> 1);
                if (from.x >= 0 && from.x < 5 && from.y >= 0 && from.y < 5)
                    agree[i] += z >= least[i] && z <= most[i] ? 1.0 : 0.0;
            }
        }
    for (int i = 0; i < 4; i++) {
        bool keep = depth[i] > 0.0 && agree[i] >= float(min_support);
        bool close = depth[i] == 0.0 && agree[i] >= MOST && far < 1.06 * near;
        imageStore(depth_out, at + ivec2(i & 1, i >> 1),
                   vec4(keep ? depth[i] : close ? sum / known : 0.0));
        if (!keep)
            imageStore(normal, at + ivec2(i & 1, i >> 1), vec4(0.0));
    }
}
