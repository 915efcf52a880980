// Samples of photographs as radiance.
#include "gather/photo.glsl"

// Radiance, and trust as far as clipping goes. Levels do not blend: between them a software
// renderer reads twice as much.
vec4 photo_sample(photo shot, vec2 pixel, float mip)
{
    vec4 texel = photo_bilinear(shot, pixel, floor(mip + 0.5));
    vec3 exposure = texel.rgb / (ORL_RADIANCE_SCALE * max(texel.a, 1e-8));
    return vec4(exposure * shot.gain.rgb, texel.a);
}

// A filter that rings brightens or darkens by no more than this factor.
const float SHARPEN_MAX = 1.5;

// What is `color` by photo_sample, sharper. Where contrasts are high, or trust falls, the
// negative lobes of this filter ring far below black: it changes by a factor, no more.
vec3 photo_sharper(photo shot, vec2 pixel, float mip, vec3 color)
{
    vec4 texel = photo_bicubic(shot, pixel, mip);
    if (!(texel.a > 1e-8))
        return color;
    vec3 sharper = texel.rgb / (ORL_RADIANCE_SCALE * texel.a) * shot.gain.rgb;
    return clamp(sharper, color / SHARPEN_MAX, color * SHARPEN_MAX);
}
