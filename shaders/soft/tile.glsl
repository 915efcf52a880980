// The splats of a tile, nearest first.
#include "soft/splat.glsl"

layout(rgba32f, binding = 6) readonly uniform imageBuffer projected;
// First the start of each tile's list and the end of the last one, then splats.
layout(r32i, binding = 7) readonly uniform iimageBuffer listed;

int listed_at(int place)
{
    return imageLoad(listed, place).x;
}

struct seen_splat {
    vec2 centre;
    vec3 inverse; // covariance's: xx, xy, yy
    float opacity;
    vec3 color;
};

seen_splat seen_at(int i)
{
    vec4 a = imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i), b = imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i + 1);
    return seen_splat(a.xy, vec3(a.zw, b.x), b.y, imageLoad(projected, ORL_SOFT_SEEN_VEC4S * i + 2).rgb);
}

// Opacity at an offset from the centre, pixels; 0: not drawn there.
float seen_opacity(seen_splat s, vec2 off)
{
    float power = -0.5 * (s.inverse.x * off.x * off.x + s.inverse.z * off.y * off.y) - s.inverse.y * off.x * off.y;
    float opacity = s.opacity * exp(min(power, 0.0));
    return opacity < OPACITY_MIN ? 0.0 : min(opacity, OPACITY_MAX);
}
