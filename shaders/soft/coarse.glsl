// The coarse part of a mipmapped picture, for the renderer and for the page: its mean over pixels of level mean_level,
// which the file that includes this one defines.

// A level under the cubic B-spline, from four bilinear samples (Sigg and Hadwiger 2005). Bilinear samples of a coarse
// level would show its pixels.
vec4 smooth_level(sampler2D tex, vec2 at, float level)
{
    vec2 size = vec2(textureSize(tex, int(level)));
    vec2 place = at * size - 0.5, f = fract(place), g = 1.0 - f;
    vec2 w0 = g * g * g / 6.0, w1 = 2.0 / 3.0 - 0.5 * f * f * (2.0 - f);
    vec2 w3 = f * f * f / 6.0, w2 = 1.0 - w0 - w1 - w3;
    vec2 low = w0 + w1, base = floor(place) + 0.5;
    vec2 a = (base - 1.0 + w1 / low) / size, b = (base + 1.0 + w3 / (w2 + w3)) / size;
    return mix(mix(textureLod(tex, b, level), textureLod(tex, vec2(a.x, b.y), level), low.x),
               mix(textureLod(tex, vec2(b.x, a.y), level), textureLod(tex, a, level), low.x), low.y);
}

vec4 coarse_at(sampler2D tex, ivec2 at)
{
    vec2 size = vec2(textureSize(tex, 0)), place = (vec2(at) + 0.5) / size;
    float last = floor(log2(max(size.x, size.y)) + 1e-3), mean = min(mean_level, last), level = floor(mean);
    return mix(smooth_level(tex, place, level), smooth_level(tex, place, min(level + 1.0, last)), mean - level);
}
