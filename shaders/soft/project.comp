// Projects the splats into a view.
#include "soft/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(rgba32f, binding = 6) writeonly uniform imageBuffer projected;
layout(std430, binding = 2) writeonly buffer splat_bounds {
    uint bounds[];
};

void main()
{
    int i = own_item();
    if (i >= splat_count)
        return;
    bounds[ORL_SOFT_BOUND_WORDS * i] = 0u;
    splat s = splat_at(i);
    vec3 p = view_rotation() * (s.position - eye.xyz);
    seen_splat seen;
    vec2 reach;
    if (!splat_seen(s, p, vec2(view_size), smooths > 0.0 ? splat_row(i, 1).w * focal.x / p.z : 1.0, seen, reach))
        return;
    ivec2 last = (view_size - 1) / ORL_SOFT_TILE;
    uvec2 from = uvec2(clamp(ivec2((seen.centre - reach) / float(ORL_SOFT_TILE)), ivec2(0), last));
    uvec2 to = uvec2(clamp(ivec2((seen.centre + reach) / float(ORL_SOFT_TILE)), ivec2(0), last));
    vec3 color = splat_color(splat_row(i, 3).rgb);
    int above = (color.r > 0.0 ? 1 : 0) + (color.g > 0.0 ? 2 : 0) + (color.b > 0.0 ? 4 : 0);
    imageStore(projected, ORL_SOFT_SEEN_VEC4S * i, vec4(seen.centre, seen.inverse.xy));
    imageStore(projected, ORL_SOFT_SEEN_VEC4S * i + 1, vec4(seen.inverse.z, seen.opacity, p.z, 0.0));
    imageStore(projected, ORL_SOFT_SEEN_VEC4S * i + 2, vec4(max(color, vec3(0.0)), float(above)));
    bounds[ORL_SOFT_BOUND_WORDS * i + 1] = from.x | from.y << 16;
    bounds[ORL_SOFT_BOUND_WORDS * i + 2] = to.x | to.y << 16;
    bounds[ORL_SOFT_BOUND_WORDS * i] = floatBitsToUint(p.z);
}
