// Moves a foreground pixel at a depth edge to the background depth when its votes and those of its
// neighbours add up in favour.
#include "edges/edge_list.glsl"

layout(local_size_x = EDGE_GROUP) in;
layout(r32f, binding = 0) writeonly uniform image2D view_depth;
layout(r32f, binding = 1) readonly uniform image2D votes; // 0: no vote
layout(rgba16f, binding = 2) writeonly uniform image2D normal;

void main()
{
    uint place = gl_GlobalInvocationID.x;
    while (place < edges_listed()) {
        ivec2 at = edge_pixel(edges[place]);
        float sum = 0.0;
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++)
                sum += imageLoad(votes, at + ivec2(x, y)).r; // 0 outside
        if (sum > 0.0) {
            imageStore(view_depth, at, vec4(uintBitsToFloat(edges[place].y)));
            imageStore(normal, at, vec4(0.0));
        }
        place += EDGE_GROUP * EDGE_GROUPS_MAX;
    }
}
