// The splats of a tile, nearest first.
#include "soft/splat.glsl"

layout(rgba32f, binding = 6) readonly uniform imageBuffer projected;
// First the start of each tile's list and the end of the last one, then splats.
layout(r32i, binding = 7) readonly uniform iimageBuffer listed;

// A ray that less than this of passes through all splats so far ends.
const float PASSES_MIN = 1e-3;

const int PIXELS = ORL_SOFT_TILE * ORL_SOFT_TILE; // of a tile

int tile_count()
{
    return tiles_across * ((view_size.y + ORL_SOFT_TILE - 1) / ORL_SOFT_TILE);
}

ivec2 first_pixel(int tile)
{
    return ORL_SOFT_TILE * ivec2(tile % tiles_across, tile / tiles_across);
}

ivec2 pixel_of_tile(int i)
{
    return ivec2(i % ORL_SOFT_TILE, i / ORL_SOFT_TILE);
}

int listed_at(int place)
{
    return imageLoad(listed, place).x;
}

seen_splat seen_at(int i)
{
    vec4 a = imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i), b = imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i + 1);
    return seen_splat(a.xy, vec3(a.zw, b.x), b.y, imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i + 2).rgb);
}
