// The coarse part of a mipmapped picture, for the renderer and for the page: its mean over pixels of the level next to
// mean_level, which the file that includes this one defines, under the cubic B-spline, from four bilinear samples (Sigg
// and Hadwiger 2005). Bilinear samples of a coarse level would show its pixels.
vec4 coarse_at(sampler2D tex, ivec2 at)
{
    ivec2 all = textureSize(tex, 0);
    float last = floor(log2(float(max(all.x, all.y))) + 1e-3), level = min(floor(mean_level + 0.5), last);
    vec2 size = vec2(textureSize(tex, int(level)));
    vec2 place = (vec2(at) + 0.5) / vec2(all) * size - 0.5, f = fract(place), g = 1.0 - f;
    vec2 w0 = g * g * g / 6.0, w1 = 2.0 / 3.0 - 0.5 * f * f * (2.0 - f);
    vec2 w3 = f * f * f / 6.0, w2 = 1.0 - w0 - w1 - w3;
    vec2 low = w0 + w1, base = floor(place) + 0.5;
    vec2 a = (base - 1.0 + w1 / low) / size, b = (base + 1.0 + w3 / (w2 + w3)) / size;
    return mix(mix(textureLod(tex, b, level), textureLod(tex, vec2(a.x, b.y), level), low.x),
               mix(textureLod(tex, vec2(b.x, a.y), level), textureLod(tex, a, level), low.x), low.y);
}
