// Costs of the planes of each cell.
#include "gather/photo.glsl"
#include "guess/cells.glsl"
#include "shared/constants.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth;  // < 0: estimated background depth
layout(r32f, binding = 1) writeonly uniform image2D estimated;  // inverse depth; 0: a closed cell
layout(std430, binding = 1) readonly buffer tile_lists {
    int chosen[];
};
layout(std430, binding = 3) writeonly buffer plane_costs_of_cells {
    float costs[];
};

float depth_at(ivec2 at)
{
    return imageLoad(view_depth, at).r;
}

int photo_to_ask(ivec2 cell, int c)
{
    ivec2 tile = cell * CELL / tile_side;
    return chosen[(tile.y * tiles_across + tile.x) * ORL_CANDIDATES + c];
}

#include "guess/cost.glsl"

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, cells_across_down())))
        return;
    float estimate = open_estimate(cell);
    int row = first_cost(cell);
    imageStore(estimated, cell, vec4(estimate));
    int first = 0, end = estimate > 0.0 ? PLANES : 1; // the first cost says that a cell is closed
    do { // the condition comes last: see gather/tiled.comp
        vec4 some = plane_costs(cell, estimate, first);
        for (int n = 0; n < AT_ONCE && first + n < PLANES; n++)
            costs[row + first + n] = estimate > 0.0 ? some[n] : CLOSED;
        first += AT_ONCE;
    } while (first < end);
}
