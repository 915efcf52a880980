// What a pixel gets from the coarser level of a filling pyramid: bilinear (Gortler 1996, push).
// far: the values are those of fill/slope.glsl.
#include "fill/slope.glsl"
uniform bool far;

// `to`: where the value is for, in pixels of the level, whose centres are whole numbers.
vec4 fill_texel(sampler2D level, ivec2 at, vec2 to)
{
    vec4 value = texelFetch(level, at, 0);
    return far ? slope_moved(slope_soft(value), to - vec2(at)) : value;
}

vec4 fill_finer(sampler2D level, ivec2 at)
{
    ivec2 last = textureSize(level, 0) - 1, parent = at / 2, side = 2 * (at & 1) - 1;
    vec2 to = vec2(parent) + 0.25 * vec2(side);
    vec4 own = fill_texel(level, min(parent, last), to);
    vec4 aside = fill_texel(level, clamp(parent + ivec2(side.x, 0), ivec2(0), last), to);
    vec4 below = fill_texel(level, clamp(parent + ivec2(0, side.y), ivec2(0), last), to);
    vec4 across = fill_texel(level, clamp(parent + side, ivec2(0), last), to);
    vec4 finer = 0.5625 * own + 0.1875 * (aside + below) + 0.0625 * across;
    return far ? slope_hard(finer) : finer;
}
