// Lists the foreground pixels at depth discontinuities, each with the background depth behind the
// edge. One invocation handles 2x2 pixels.
#define BLOCK_GATHER
#include "shared/render_blocks.h"
#include "edges/edge_list.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: estimated background depth

// Depths with at least this ratio form an edge.
const float EDGE_RATIO = 1.03;

void main()
{
    ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (corner.x >= view_size.x || corner.y >= view_size.y)
        return;
    float own[4], behind[4], before[4];
    vec2 inward[4]; // direction in which the surface of this pixel continues
    for (int k = 0; k < 4; k++) {
        own[k] = imageLoad(view_depth, corner + ivec2(k & 1, k >> 1)).r; // 0 outside
        behind[k] = own[k];
        before[k] = abs(own[k]);
        inward[k] = vec2(0.0);
    }
    for (int y = -reach; y <= reach + 1; y++)
        for (int x = -reach; x <= reach + 1; x++) {
            float other = imageLoad(view_depth, corner + ivec2(x, y)).r, far = abs(other);
            for (int k = 0; k < 4; k++) {
                ivec2 off = ivec2(x - (k & 1), y - (k >> 1));
                bool around = max(abs(off.x), abs(off.y)) <= reach;
                behind[k] = around && far > abs(behind[k]) ? other : behind[k];
                before[k] = around && far > 0.0 ? min(far, before[k]) : before[k];
                float same = far < EDGE_RATIO * own[k] ? 1.0 : -1.0;
                inward[k] += around ? vec2(off) * same : vec2(0.0);
            }
        }
    for (int k = 0; k < 4; k++) {
        // In logarithms, the depth is closer to that of the foreground than to the background's.
        float far = abs(behind[k]);
        if (own[k] > 0.0 && far > EDGE_RATIO * before[k] && own[k] * own[k] < far * before[k])
            edge_add(corner + ivec2(k & 1, k >> 1),
                     uvec3(floatBitsToUint(behind[k]), packHalf2x16(inward[k]), 0u));
    }
}
