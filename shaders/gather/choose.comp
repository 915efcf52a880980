// Lists, for each tile of the screen, the photographs that can paint it best, so that the cost of a
// pixel does not grow with the number of photographs.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: estimated background depth
layout(std430, binding = 1) writeonly buffer tile_lists {
    int chosen[]; // ORL_CANDIDATES per tile, best first, -1: none
};

float depth_at(ivec2 at)
{
    return imageLoad(view_depth, at).r;
}

#include "gather/candidates.glsl"

void main()
{
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    int row = tiles_across, rows = (view_size.y + tile_side - 1) / tile_side;
    if (tile.x >= row || tile.y >= rows)
        return;
    int index[ORL_CANDIDATES];
    list_candidates(tile, tile_side, view_size, photo_count, index);
    for (int c = 0; c < ORL_CANDIDATES; c++)
        chosen[(tile.y * row + tile.x) * ORL_CANDIDATES + c] = index[c];
}
