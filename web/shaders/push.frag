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

surfel filled(vec2 target, float own_near, surfel disc[4], vec2 centre[4], vec4 weight)
{
    vec2 target_ray = camera_ray(target);
    float front = 1e38, front_far = 0.0;
    bool hit[4];
    for (int i = 0; i < 4; i++) {
        bool inside;
        float depth = surfel_depth_at(disc[i], camera_ray(centre[i]), target_ray, inside);
        // A disc smaller than a pixel still closes empty pixels around its centre.
        vec2 off = centre[i] - target;
        bool closes = own_near <= 0.0 &&
                      dot(off, off) <= SURFEL_MIN_RADIUS_PX * SURFEL_MIN_RADIUS_PX;
        hit[i] = disc[i].radius > 0.0 && depth > 0.0 && (inside || closes);
        bool nearer = hit[i] && disc[i].near < front;
        front = nearer ? disc[i].near : front;
        front_far = nearer ? disc[i].far : front_far;
    }
    surfel sum = surfel(front, front_far, 0.0, 0.0, vec3(0.0), vec2(0.0));
    float total = 0.0;
    for (int i = 0; i < 4; i++) {
        float w = hit[i] && disc[i].near <= front_far ? weight[i] : 0.0;
        sum.far = max(sum.far, w > 0.0 ? disc[i].far : 0.0);
        sum.depth += w * disc[i].depth;
        sum.radius += w * disc[i].radius;
        sum.normal += w * disc[i].normal;
        sum.displacement += w * (centre[i] - target);
        total += w;
    }
    // A pixel with a surface of its own keeps it unless a nearer disc hides it.
    if (total == 0.0 || (own_near > 0.0 && own_near <= front_far))
        return NO_SURFEL;
    float scale = 1.0 / total;
    sum.depth *= scale;
    sum.radius *= scale;
    sum.displacement *= scale;
    if (!(dot(sum.normal, sum.normal) > 1e-12))
        sum.normal = NO_SURFEL.normal;
    return sum;
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 corner = (at + 1) / 2 - 1; // the coarse pixel above and left of the corner
    ivec2 side = at - (2 * corner + 1);
    surfel disc[4];
    vec2 centre[4];
    vec4 weight;
    for (int i = 0; i < 4; i++) {
        ivec2 off = ivec2(i & 1, i >> 1), from = corner + off;
        disc[i] = NO_SURFEL;
        if (within(from, textureSize(coarse_a, 0)))
            disc[i] = surfel_unpack(texelFetch(coarse_a, from, 0),
                                    uvec4(texelFetch(coarse_b, from, 0).xy, 0u, 0u));
        centre[i] = level_centre(from, level + 1) + disc[i].displacement;
        weight[i] = (off.x == side.x ? 0.75 : 0.25) * (off.y == side.y ? 0.75 : 0.25);
    }
    vec2 target = level_centre(at, level);
#ifdef LAST
    surfel own = level0(at);
    float own_depth = surfel_own_depth(own, camera_ray(target + own.displacement),
                                       camera_ray(target));
    surfel s = filled(target, own_depth, disc, centre, weight);
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
    surfel s = filled(target, own_a.x, disc, centre, weight);
    filled_a = s.radius > 0.0 ? surfel_pack_a(s) : own_a;
    filled_b = s.radius > 0.0 ? surfel_pack_b(s).xy : own_b;
#endif
}
