// Picks the plane of least cost of each open cell, between planes by a parabola, if it costs
// clearly less than the estimate.
#define BLOCK_GATHER
#include "shared/render_blocks.h"
#include "guess/planes.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 1) readonly uniform image2D estimated; // inverse depth; 0: a closed cell
layout(r32f, binding = 2) writeonly uniform image2D picked;   // share of it; 1: the estimate itself
layout(std430, binding = 4) readonly buffer path_costs {
    float sums[];
};

// Least gain, of the sum over four directions.
const float CLEARLY = 0.3;

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, cells_across_down())))
        return;
    int row = first_cost(cell), best = 0;
    for (int k = 1; k < PLANES; k++)
        best = sums[row + k] < sums[row + best] ? k : best;
    float least = sums[row + best];
    float before = sums[row + max(best - 1, 0)], after = sums[row + min(best + 1, PLANES - 1)];
    float bend = before + after - 2.0 * least;
    bool between = best > 0 && best < PLANES - 1 && bend > 0.0;
    float off = between ? 0.5 * (before - after) / bend : 0.0;
    bool better = sums[row] - least > CLEARLY && imageLoad(estimated, cell).r > 0.0;
    imageStore(picked, cell, vec4(better ? plane_share(float(best) + off) : 1.0));
}
