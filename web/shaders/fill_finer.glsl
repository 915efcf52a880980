// What a pixel gets from the coarser level of a filling pyramid: bilinear (Gortler 1996, push).
// FAR: of depths, as in shaders/fill/fill.glsl: by the fourth roots of their weights.
vec4 fill_texel(sampler2D level, ivec2 at)
{
    vec4 value = texelFetch(level, at, 0);
#ifdef FAR
    value = value.a > 0.0 ? value * (sqrt(sqrt(value.a)) / value.a) : vec4(0.0);
#endif
    return value;
}

vec4 fill_finer(sampler2D level, ivec2 at)
{
    ivec2 last = textureSize(level, 0) - 1, parent = at / 2, side = 2 * (at & 1) - 1;
    vec4 own = fill_texel(level, min(parent, last));
    vec4 aside = fill_texel(level, clamp(parent + ivec2(side.x, 0), ivec2(0), last));
    vec4 below = fill_texel(level, clamp(parent + ivec2(0, side.y), ivec2(0), last));
    vec4 across = fill_texel(level, clamp(parent + side, ivec2(0), last));
    vec4 finer = 0.5625 * own + 0.1875 * (aside + below) + 0.0625 * across;
#ifdef FAR
    finer *= finer.a * finer.a * finer.a;
#endif
    return finer;
}
