// Lists, for each tile of the screen, the photographs that can paint it best, so that the cost of a
// pixel does not grow with the number of photographs.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"
#include "gather/candidates.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: estimated background depth
layout(std430, binding = 1) writeonly buffer tile_lists {
    int chosen[]; // ORL_CANDIDATES per tile, best first, -1: none
};

const int ACROSS = 3; // sample points of a tile in each direction

// Sample points of a tile in the view's camera frame; z 0: no depth there. guess: 1 where the depth
// is estimated, else 0.
void sample_depths(ivec2 tile, out vec3 points[ACROSS * ACROSS], out float guess[ACROSS * ACROSS])
{
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        ivec2 at = tile * tile_side + (2 * ivec2(i % ACROSS, i / ACROSS) + 1) * tile_side /
                                            (2 * ACROSS);
        at = min(at, view_size - 1);
        float depth = imageLoad(view_depth, at).r;
        points[i] = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * abs(depth);
        guess[i] = depth < 0.0 ? 1.0 : 0.0;
    }
}

void main()
{
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    int row = tiles_across, rows = (view_size.y + tile_side - 1) / tile_side;
    if (tile.x >= row || tile.y >= rows)
        return;
    vec3 points[ACROSS * ACROSS];
    float guess[ACROSS * ACROSS];
    sample_depths(tile, points, guess);
    float best[ORL_CANDIDATES];
    int index[ORL_CANDIDATES];
    for (int c = 0; c < ORL_CANDIDATES; c++) {
        best[c] = NOT_SEEN;
        index[c] = -1;
    }
    int i = 0;
    do { // the condition comes last: see tiled.comp
        float least = NOT_SEEN, seen = 0.0;
        photo source = photo_at(i);
        for (int s = 0; s < ACROSS * ACROSS; s++)
            candidate_sample(source, points[s], guess[s], least, seen);
        candidate_insert(candidate_penalty(least, seen), i, best, index);
        i++;
    } while (i < photo_count);
    for (int c = 0; c < ORL_CANDIDATES; c++)
        chosen[(tile.y * row + tile.x) * ORL_CANDIDATES + c] = index[c];
}
