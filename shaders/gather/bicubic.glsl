// The filter of photographs, from five bilinear fetches. size is that of level 0 of the slot, in
// pixels. The file that includes this one defines photo_texel.
//
// Where the view is about as fine as the photograph: Catmull-Rom (Sigg and Hadwiger 2005). Bilinear
// sampling would blur every photograph by an amount that depends on the sub-pixel position.
//
// Where a pixel of the view covers more: the mean of four bilinear samples of a finer level. Around
// the pixel's place they stand as far apart as gives their weights, with those of the mip levels
// before, the variance of a box of the pixel's width: it is (width^2 - 1) / 12, and 1 / 6 is that of
// a bilinear sample, in the mean over positions. A bicubic sample of the level that is as coarse as
// the view would blur what is near the limit of the view's resolution.

// From this width on, in pixels, the variance is that of a bilinear sample or more.
const float AREA_FROM = 1.73205;

vec4 bicubic(vec2 pixel, float slot, vec2 size, float mip)
{
    bool covers_more = exp2(mip) >= AREA_FROM;
    float lod = max(floor(mip) - 1.0, 0.0), width = exp2(mip - lod);
    vec2 size_at = max(floor(size / exp2(lod)), vec2(1.0));
    vec2 at = pixel / size * size_at, base = floor(at - 0.5), f = at - 0.5 - base;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 w3 = f * f * (-0.5 + 0.5 * f);
    vec2 w12 = w1 + w2;
    vec2 p0 = base - 0.5, p3 = base + 2.5, p12 = base + 0.5 + w2 / w12;
    float apart = sqrt(max((width * width - 1.0) / 12.0 - 1.0 / 6.0, 0.0));
    vec2 low = at - apart, high = at + apart;
    vec2 texel = 1.0 / size_at;
    float near = w12.x * w12.y;
    vec4 around = vec4(w12.x * w0.y, w0.x * w12.y, w3.x * w12.y, w12.x * w3.y);
    near = covers_more ? 0.0 : near;
    around = covers_more ? vec4(0.25) : around;
    // The four corners of Catmull-Rom are omitted, since their weights are almost zero.
    vec4 sum = photo_texel((covers_more ? low : vec2(p12.x, p0.y)) * texel, slot, lod) * around.x +
               photo_texel((covers_more ? vec2(low.x, high.y) : vec2(p0.x, p12.y)) * texel, slot, lod) *
                   around.y +
               photo_texel((covers_more ? at : p12) * texel, slot, lod) * near +
               photo_texel((covers_more ? vec2(high.x, low.y) : vec2(p3.x, p12.y)) * texel, slot, lod) *
                   around.z +
               photo_texel((covers_more ? high : vec2(p12.x, p3.y)) * texel, slot, lod) * around.w;
    return max(sum / (near + around.x + around.y + around.z + around.w), 0.0);
}
