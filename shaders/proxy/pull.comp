// One pull step: makes a coarser level from 2x2 finer pixels.
#define BLOCK_PYRAMID
#include "shared/render_blocks.h"
#include "proxy/octahedron.glsl"
#include "proxy/surfel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D fine_a;
layout(rg32ui, binding = 1) readonly uniform uimage2D fine_b;
layout(rgba32f, binding = 2) writeonly uniform image2D coarse_a;
layout(rg32ui, binding = 3) writeonly uniform uimage2D coarse_b;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= level_size.x || at.y >= level_size.y)
        return;
    surfel child[4];
    for (int i = 0; i < 4; i++) {
        ivec2 from = 2 * at + ivec2(i & 1, i >> 1);
        // Loads outside the level give zero, which is an empty pixel.
        child[i] = surfel_unpack(imageLoad(fine_a, from), imageLoad(fine_b, from));
    }
    surfel merged = surfel_merge(child, level_number - 1);
    imageStore(coarse_a, at, surfel_pack_a(merged));
    imageStore(coarse_b, at, surfel_pack_b(merged));
}
