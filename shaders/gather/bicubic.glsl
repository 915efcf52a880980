// The filter of photographs, from five bilinear fetches. size is that of level 0 of the slot, in
// pixels. The file that includes this one defines photo_texel.
//
// Where the view is about as fine as the photograph: Catmull-Rom. Bilinear sampling would blur every photograph by an
// amount that depends on the sub-pixel position f: by f (1 - f) / 2 of the second difference of bilinear samples that lie
// a pixel apart, along each axis. Along one axis that is all; the product of both is omitted, since it is almost zero.
//
// Where a pixel of the view covers more: the mean of four bilinear samples of a finer level. Around
// the pixel's place they stand as far apart as gives their weights, with those of the mip levels
// before, the variance of a box of the pixel's width: it is (width^2 - 1) / 12, and 1 / 6 is that of
// a bilinear sample, in the mean over positions. A bicubic sample of the level that is as coarse as
// the view would blur what is near the limit of the view's resolution.
#include "gather/stored.glsl"

// From this width on, in pixels, the variance is that of a bilinear sample or more.
const float AREA_FROM = 1.73205;

struct filtered {
    vec4 sharp, plain; // plain: before the blur is undone; the same where a pixel of the view covers more
    float varies;      // how much the photograph varies from one pixel of the view to the next; 1: unknown
};

filtered bicubic(vec2 pixel, float slot, vec2 size, float mip)
{
    bool covers_more = exp2(mip) >= AREA_FROM;
    float lod = max(floor(mip) - 1.0, 0.0), width = exp2(mip - lod);
    vec2 size_at = max(floor(size / exp2(lod)), vec2(1.0));
    vec2 at = pixel / size * size_at, f = fract(at - 0.5), texel = 1.0 / size_at;
    float apart = sqrt(max((width * width - 1.0) / 12.0 - 1.0 / 6.0, 0.0));
    vec2 one = covers_more ? vec2(apart) : vec2(1.0, 0.0), other = covers_more ? vec2(apart, -apart) : vec2(0.0, 1.0);
    vec2 blur = covers_more ? vec2(0.0) : 0.5 * f * (1.0 - f);
    vec4 middle = photo_texel(at * texel, slot, lod);
    vec4 left = photo_texel((at - one) * texel, slot, lod), right = photo_texel((at + one) * texel, slot, lod);
    vec4 up = photo_texel((at - other) * texel, slot, lod), down = photo_texel((at + other) * texel, slot, lod);
    vec4 plain = covers_more ? stored_mean(left, right, up, down) : middle;
    vec4 sharp = max(plain - blur.x * (left + right - 2.0 * middle) - blur.y * (up + down - 2.0 * middle), 0.0);
    vec3 differ = max(max(max(left, right), max(up, down)), middle).rgb - min(min(min(left, right), min(up, down)), middle).rgb;
    // Where a pixel of the view covers more, all samples lie within it, and nothing is known.
    float varies = covers_more ? 1.0 : width * max(max(differ.r, differ.g), differ.b);
    return filtered(sharp, plain, varies);
}
