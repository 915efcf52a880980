// Picks the plane of each open cell.
#define BLOCK_GATHER
#include "shared/render_blocks.h"
#include "guess/cells.glsl"
#include "guess/pick.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 1) readonly uniform image2D estimated; // inverse depth; 0: a closed cell
layout(r32f, binding = 2) writeonly uniform image2D picked;   // share of it; 1: the estimate itself
layout(std430, binding = 4) readonly buffer path_costs {
    float sums[];
};

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, cells_across_down())))
        return;
    int row = first_cost(cell);
    float own[PLANES];
    for (int k = 0; k < PLANES; k++)
        own[k] = sums[row + k];
    imageStore(picked, cell, vec4(imageLoad(estimated, cell).r > 0.0 ? picked_share(own) : 1.0));
}
