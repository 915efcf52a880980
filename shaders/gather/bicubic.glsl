// Catmull-Rom filter from five bilinear fetches (Sigg and Hadwiger 2005). Bilinear sampling would
// blur every photograph by an amount that depends on the sub-pixel position. size is that of level 0
// of the slot, in pixels. The file that includes this one defines photo_texel.
vec4 bicubic(vec2 pixel, float slot, vec2 size, float mip)
{
    float lod = floor(mip + 0.5);
    vec2 size_at = max(floor(size / exp2(lod)), vec2(1.0));
    vec2 at = pixel / size * size_at - 0.5;
    vec2 base = floor(at), f = at - base;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 w3 = f * f * (-0.5 + 0.5 * f);
    vec2 w12 = w1 + w2;
    vec2 p0 = (base - 0.5) / size_at, p3 = (base + 2.5) / size_at;
    vec2 p12 = (base + 0.5 + w2 / w12) / size_at;
    vec4 sum = photo_texel(vec2(p12.x, p0.y), slot, lod) * (w12.x * w0.y) +
               photo_texel(vec2(p0.x, p12.y), slot, lod) * (w0.x * w12.y) +
               photo_texel(p12, slot, lod) * (w12.x * w12.y) +
               photo_texel(vec2(p3.x, p12.y), slot, lod) * (w3.x * w12.y) +
               photo_texel(vec2(p12.x, p3.y), slot, lod) * (w12.x * w3.y);
    float total = w12.x * w0.y + w0.x * w12.y + w12.x * w12.y + w3.x * w12.y + w12.x * w3.y;
    // The four corners are omitted, since their weights are almost zero.
    return max(sum / total, 0.0);
}
