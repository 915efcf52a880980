// Blends each pixel's splats from the nearest on: colour (sRGB), and what passes through all of them. One invocation
// takes a whole tile: a software renderer fetches a splat for each invocation again.
#include "soft/tile.glsl"

layout(local_size_x = ORL_SOFT_TILE_GROUP) in;
layout(rgba32f, binding = 0) writeonly uniform image2D blended;

void main()
{
    int tile = own_item();
    if (tile >= tile_count())
        return;
    vec4 sums[PIXELS]; // colour, what passes
    for (int i = 0; i < PIXELS; i++)
        sums[i] = vec4(0.0, 0.0, 0.0, 1.0);
    float most = 1.0; // that passes to one of the pixels
    int end = listed_at(tile + 1);
    for (int k = listed_at(tile); k < end && most >= PASSES_MIN; k++) {
        seen_splat s = seen_at(listed_at(k));
        vec2 off = vec2(first_pixel(tile)) + 0.5 - s.centre;
        most = 0.0;
        for (int i = 0; i < PIXELS; i++) {
            float share = sums[i].a < PASSES_MIN ? 0.0 : sums[i].a * seen_opacity(s, off + vec2(pixel_of_tile(i)));
            sums[i] += vec4(share * s.color, -share);
            most = max(most, sums[i].a);
        }
    }
    for (int i = 0; i < PIXELS; i++)
        imageStore(blended, first_pixel(tile) + pixel_of_tile(i), sums[i]); // nothing outside
}
