// Lists, for each tile of the screen, the photographs that contribute most to its radiance. A few
// probe points of the tile ask every photograph for geometric weight, visibility and confidence.
#include <sample>
#include <visibility>
#include <weight>
#include "gather/ask.glsl"
#include "gather/radiance/samples.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(r32f, binding = 0) readonly uniform image2D view_depth; // < 0: estimated background depth
layout(rgba16f, binding = 4) readonly uniform image2D view_normal;
layout(std430, binding = 1) writeonly buffer tile_lists {
    // ORL_RADIANCE_LIST per tile: photographs, best first, -1: none; bits of the best one's weight.
    int chosen[];
};

const int PROBES_X = 4, PROBES_Y = 2;
const ivec2 TILE = ivec2(ORL_PIXEL_GROUP_X, ORL_PIXEL_GROUP_Y);
const float LEAST_SHARE = 0.01; // least weight of a listed photograph, fraction of the best one's
const float CLIPPED_SHARE = 0.1; // least score of a photograph, fraction of its geometric weight

// The greatest weight of a photograph at any probe point.
float score(int i, ivec2 tile)
{
    float most = 0.0;
    photo source = photo_at(i);
    for (int k = 0; k < PROBES_X * PROBES_Y; k++) {
        ivec2 at = tile * TILE + (2 * ivec2(k % PROBES_X, k / PROBES_X) + 1) *
                                     (TILE / (2 * ivec2(PROBES_X, PROBES_Y)));
        at = min(at, view_size - 1);
        float depth = imageLoad(view_depth, at).r;
        if (depth == 0.0)
            continue;
        Point point = Point(surface_point(at, abs(depth)), imageLoad(view_normal, at).xyz,
                            depth < 0.0);
        Answer a = ask(source, i, point);
        Sample s = sample_of(source, a, point.guessed);
        // A clipped sample still reveals samples that are too dark (radiance/merge.glsl).
        most = max(most, max(weight_alone(source, s), CLIPPED_SHARE * s.weight));
    }
    return most;
}

void main()
{
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy), tiles = (view_size + TILE - 1) / TILE;
    if (any(greaterThanEqual(tile, tiles)))
        return;
    float best[ORL_RADIANCE_KEPT];
    int index[ORL_RADIANCE_KEPT];
    for (int k = 0; k < ORL_RADIANCE_KEPT; k++) {
        best[k] = 0.0;
        index[k] = -1;
    }
    for (int i = 0; i < photo_count; i++) {
        float mine = score(i, tile);
        int candidate = i;
        for (int k = 0; k < ORL_RADIANCE_KEPT; k++) { // insertion sort
            if (mine > best[k]) {
                float b = best[k];
                int n = index[k];
                best[k] = mine;
                index[k] = candidate;
                mine = b;
                candidate = n;
            }
        }
    }
    int list = ORL_RADIANCE_LIST * (tile.y * tiles.x + tile.x);
    for (int k = 0; k < ORL_RADIANCE_KEPT; k++)
        chosen[list + k] = best[k] >= LEAST_SHARE * best[0] ? index[k] : -1;
    chosen[list + ORL_RADIANCE_KEPT] = floatBitsToInt(best[0]);
}
