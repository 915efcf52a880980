// A pixel of the picture, on its way to what soft splats show in it, in sRGB. Light above white stays.
#include "shared/srgb.glsl"
#include "soft/luma.glsl"

// Luma of sRGB. Where picture and splats differ by less, luma cannot tell how far a pixel should go, and it goes less far.
const float GAP_SURE = 0.04;

// own: linear colour, coverage; soft: sRGB colour of the splats, what passes; more: the correction, in luma of sRGB. A
// pixel goes so far towards the splats that its luma grows by about `more`, but not past them: splats are blurred where
// photographs are sharp, and what overshoots stands out as a speck. Then it goes mix_share of the way that is left.
vec4 soft_mixed(vec4 own, vec4 soft, float more, float mix_share)
{
    vec3 white = clamp(own.rgb, 0.0, 1.0), picture = srgb_encode(white);
    vec3 splats = clamp(soft.rgb, 0.0, 1.0) + soft.a * picture;
    float gap = luma_of(splats - picture);
    float way = clamp(more * gap / (gap * gap + GAP_SURE * GAP_SURE), 0.0, 1.0);
    vec3 mixed = srgb_decode(clamp(mix(picture, splats, mix(way, 1.0, mix_share)), 0.0, 1.0));
    return vec4(mixed + own.rgb - white, own.a);
}
