// Where depth steps, a pixel shows what is on both sides.
#include "edges/edge.glsl"
uniform sampler2D composed, depth;
uniform float footprint; // pixels of a photograph in one of the view, each way

float inverse_at(ivec2 at)
{
    float z = texelFetch(depth, at, 0).x;
    return z > 0.0 ? 1.0 / z : 0.0;
}

vec3 antialiased(ivec2 at)
{
    vec3 own = texelFetch(composed, at, 0).rgb;
    if (min(at.x, at.y) < 1 || any(greaterThanEqual(at, textureSize(depth, 0) - 1)))
        return own;
    const ivec2 along[4] = ivec2[4](ivec2(1, 0), ivec2(-1, 1), ivec2(0, 1), ivec2(1, 1));
    vec4 before, after;
    for (int n = 0; n < 4; n++) {
        before[n] = inverse_at(at - along[n]);
        after[n] = inverse_at(at + along[n]);
    }
    float aside = edge_aside(inverse_at(at), before, after, footprint);
    if (!(aside > 0.0))
        return own;
    vec3 around[9];
    for (int n = 0; n < 9; n++)
        around[n] = texelFetch(composed, at + ivec2(n % 3, n / 3) - 1, 0).rgb;
    return edge_mean(around, aside);
}
