// Drops stray points: a front without neighbours hangs in the air. A pixel stays when enough
// of the 5x5 around have a surface within 3 % of its depth. 2x2 pixels an invocation.
#define BLOCK_PYRAMID
#include "include/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D depth_in;
layout(r32f, binding = 1) writeonly uniform image2D depth_out;
layout(rgba16f, binding = 2) writeonly uniform image2D normal;

void main()
{
    ivec2 at = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= level.x || at.y >= level.y)
        return;
    float depth[4], agree[4];
    for (int i = 0; i < 4; i++) {
        depth[i] = imageLoad(depth_in, at + ivec2(i & 1, i >> 1)).x;
        agree[i] = 0.0;
    }
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 6; x++) {
            float z = imageLoad(depth_in, clamp(at + ivec2(x, y) - 2, ivec2(0), level.xy - 1)).x;
            for (int i = 0; i < 4; i++) {
                ivec2 from = ivec2(x, y) - ivec2(i & 1, i >> 1);
                if (from.x >= 0 && from.x < 5 && from.y >= 0 && from.y < 5)
                    agree[i] += abs(z - depth[i]) < 0.03 * depth[i] ? 1.0 : 0.0;
            }
        }
    for (int i = 0; i < 4; i++) {
        bool keep = depth[i] > 0.0 && agree[i] >= float(level.w);
        imageStore(depth_out, at + ivec2(i & 1, i >> 1), vec4(keep ? depth[i] : 0.0));
        if (!keep)
            imageStore(normal, at + ivec2(i & 1, i >> 1), vec4(0.0));
    }
}
