// Samples photographs as radiance.
#include "gather/photo.glsl"

// Radiance, and the confidence weight with respect to clipping. Mip levels are not interpolated,
// since a software renderer would read twice as much.
vec4 photo_sample(photo source, vec2 pixel, float mip)
{
    vec4 texel = photo_bilinear(source, pixel, floor(mip + 0.5));
    vec3 exposure = texel.rgb / (ORL_RADIANCE_SCALE * max(texel.a, 1e-8));
    return vec4(exposure * source.gain.rgb, texel.a);
}

// Largest factor by which the ringing of the sharpening filter may brighten or darken.
const float SHARPEN_MAX = 1.5;

// The sample `color` of photo_sample, read again with the bicubic filter. At high contrasts, or
// where confidence falls, the filter's negative lobes ring far below black, so the change is
// limited to a factor.
vec3 photo_sharper(photo source, vec2 pixel, float mip, vec3 color)
{
    vec4 texel = photo_bicubic(source, pixel, mip).sharp;
    if (!(texel.a > 1e-8))
        return color;
    vec3 sharper = texel.rgb / (ORL_RADIANCE_SCALE * texel.a) * source.gain.rgb;
    return clamp(sharper, color / SHARPEN_MAX, color * SHARPEN_MAX);
}
