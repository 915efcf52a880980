// Averages each pixel that antialias_find.comp listed with its 3x3 neighbourhood.
#include "edges/edge.glsl"
#include "edges/listed.glsl"

vec3 edge_color(uvec4 edge)
{
    vec3 around[9];
    for (int n = 0; n < 9; n++)
        around[n] = imageLoad(color, edge_pixel(edge) + ivec2(n % 3, n / 3) - 1).rgb;
    return edge_mean(around, uintBitsToFloat(edge.y));
}
