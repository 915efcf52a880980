// What a pixel gets from the coarser level of a filling pyramid: bilinear (Gortler 1996, push).
vec4 fill_finer(sampler2D level, ivec2 at)
{
    ivec2 last = textureSize(level, 0) - 1, parent = at / 2, side = 2 * (at & 1) - 1;
    vec4 own = texelFetch(level, min(parent, last), 0);
    vec4 aside = texelFetch(level, clamp(parent + ivec2(side.x, 0), ivec2(0), last), 0);
    vec4 below = texelFetch(level, clamp(parent + ivec2(0, side.y), ivec2(0), last), 0);
    vec4 across = texelFetch(level, clamp(parent + side, ivec2(0), last), 0);
    return 0.5625 * own + 0.1875 * (aside + below) + 0.0625 * across;
}
