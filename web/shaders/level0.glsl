// Level 0 of the pyramid: the nearest point of a pixel, moved to the mean depth of its layer, since
// the nearest of many noisy points is too near.
#include "shared/constants.h"
#include "proxy/octahedron.glsl"
#include "proxy/surfel.glsl"

uniform sampler2D splats; // splats.frag
uniform highp usampler2D splat_normals;
uniform sampler2D layers; // layer.frag
uniform float front_layer;
uniform vec4 view_focal;
uniform float near; // depth nearer than which large splats are outliers

bool within(ivec2 at, ivec2 area)
{
    return at.x >= 0 && at.y >= 0 && at.x < area.x && at.y < area.y;
}

surfel level0(ivec2 at)
{
    if (!within(at, textureSize(splats, 0)))
        return NO_SURFEL;
    vec4 splat = texelFetch(splats, at, 0);
    vec2 layer = texelFetch(layers, at, 0).xy;
    float behind = layer.y > 1.5 ? min(layer.x / layer.y, 1.0) : 0.0;
    float depth = splat.x * (1.0 + behind * front_layer);
    bool outlier = depth < near && splat.y * view_focal.y > ORL_OUTLIER_SHARE * float(textureSize(splats, 0).y) * depth;
    float radius = outlier ? 0.0 : splat.y;
    vec3 n = octahedron_decode(unpackSnorm2x16(texelFetch(splat_normals, at, 0).x));
    return surfel(depth, depth + radius, depth, radius, n, splat.zw);
}
