// Empty and occluded pixels of a finer level are filled from those of the four nearest coarser
// pixels whose disc they lie in, as shaders/proxy/push.comp does.
// LAST: level 0, which comes out as depth and normal at pixel centres.
#include "level0.glsl"

uniform sampler2D coarse_a;
uniform highp usampler2D coarse_b;
#ifdef LAST
layout(location = 0) out float depth_out; // 0: none
layout(location = 1) out vec4 normal_out; // half of it and a half; a: 1 on a splat
const int level = 0;
#else
uniform sampler2D fine_a;
uniform highp usampler2D fine_b;
uniform int level; // that is written
layout(location = 0) out vec4 filled_a;
layout(location = 1) out uvec2 filled_b;
#endif

vec2 camera_ray(vec2 pixel)
{
    return (pixel - view_focal.zw) / view_focal.xy;
}

#include "proxy/push.glsl"

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 corner = (at + 1) / 2 - 1; // the coarse pixel above and left of the corner
    ivec2 side = at - (2 * corner + 1);
    surfel disc[4];
    vec2 centre[4], ray[4];
    vec4 weight;
    for (int i = 0; i < 4; i++) {
        ivec2 off = ivec2(i & 1, i >> 1), from = corner + off;
        disc[i] = NO_SURFEL;
        if (within(from, textureSize(coarse_a, 0)))
            disc[i] = surfel_unpack(texelFetch(coarse_a, from, 0),
                                    uvec4(texelFetch(coarse_b, from, 0).xy, 0u, 0u));
        centre[i] = level_centre(from, level + 1) + disc[i].displacement;
        ray[i] = camera_ray(centre[i]);
        weight[i] = (off.x == side.x ? 0.75 : 0.25) * (off.y == side.y ? 0.75 : 0.25);
    }
    vec2 target = level_centre(at, level);
#ifdef LAST
    surfel own = level0(at);
    float own_depth = surfel_own_depth(own, camera_ray(target + own.displacement),
                                       camera_ray(target));
    surfel s = filled(target, supported(own_depth, disc), disc, centre, ray, weight);
    bool kept = s.radius == 0.0, inside;
    vec3 n = kept ? own.normal : normalize(s.normal);
    s.normal = n;
    float depth = surfel_depth_at(s, camera_ray(target + s.displacement), camera_ray(target),
                                  inside);
    depth_out = kept ? own_depth : depth;
    normal_out = depth_out > 0.0 ? vec4(0.5 + 0.5 * n, kept ? 1.0 : 0.5) : vec4(0.0);
#else
    vec4 own_a = texelFetch(fine_a, at, 0);
    uvec2 own_b = texelFetch(fine_b, at, 0).xy;
    surfel s = filled(target, own_a.x, disc, centre, ray, weight);
    filled_a = s.radius > 0.0 ? surfel_pack_a(s) : own_a;
    filled_b = s.radius > 0.0 ? surfel_pack_b(s).xy : own_b;
#endif
}
