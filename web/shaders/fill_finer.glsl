// What a pixel gets from the coarser level of a filling pyramid: bilinear (Gortler 1996, push).
// far: of inverse depth in x and its slope in yz, per pixel of the level, each times the weight in a.
// As in shaders/fill/fill.glsl, they are interpolated with the fourth roots of their weights.
uniform bool far;

// `to`: where the value is for, in pixels of the level, whose centres are whole numbers.
vec4 fill_texel(sampler2D level, ivec2 at, vec2 to)
{
    vec4 value = texelFetch(level, at, 0);
    if (far) {
        value = value.a > 0.0 ? value * (sqrt(sqrt(value.a)) / value.a) : vec4(0.0);
        value.x += dot(value.yz, to - vec2(at));
    }
    return value;
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
    if (far) {
        finer.yz *= 0.5; // pixels of the finer level are half as large
        finer *= finer.a * finer.a * finer.a;
    }
    return finer;
}
