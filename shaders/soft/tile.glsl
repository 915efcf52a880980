// The splats of a tile, nearest first.
#include "soft/splat.glsl"

layout(rgba32f, binding = 6) readonly uniform imageBuffer projected;
// First the start of each tile's list and the end of the last one, then splats.
layout(r32i, binding = 7) readonly uniform iimageBuffer listed;

// A ray that less than this of passes through all splats so far ends.
const float PASSES_MIN = 1e-3;

int listed_at(int place)
{
    return imageLoad(listed, place).x;
}

seen_splat seen_at(int i)
{
    vec4 a = imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i), b = imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i + 1);
    return seen_splat(a.xy, vec3(a.zw, b.x), b.y, imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i + 2).rgb);
}
