// Blends each pixel's splats from the nearest on: colour (sRGB), and what passes through all of them.
#include "soft/tile.glsl"

layout(local_size_x = ORL_SOFT_BLEND_GROUP, local_size_y = ORL_SOFT_BLEND_GROUP) in;
layout(rgba32f, binding = 0) writeonly uniform image2D blended;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    int tile = at.y / ORL_SOFT_TILE * tiles_across + at.x / ORL_SOFT_TILE;
    int k = listed_at(tile), end = listed_at(tile + 1);
    vec2 pixel = vec2(at) + 0.5;
    vec3 color = vec3(0.0);
    float passes = 1.0;
    while (k < end && passes >= PASSES_MIN) {
        seen_splat s = seen_at(listed_at(k));
        float share = passes * seen_opacity(s, pixel - s.centre);
        color += share * s.color;
        passes -= share;
        k++;
    }
    imageStore(blended, at, vec4(color, passes));
}
