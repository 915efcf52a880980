// A pixel of the picture, on its way to what soft splats show in it, in sRGB. Light above white stays.
#include "shared/srgb.glsl"
#include "soft/luma.glsl"

// A difference in luma between the picture and the splats of less than this says little about colour.
const float GAP_SURE = 0.04;

// own: linear colour, coverage; soft: sRGB colour of the splats, what passes; more: the correction, in luma of sRGB. A
// pixel goes as far towards the splats as makes its luma greater by `more`, but not past them: splats are blurred where
// photographs are sharp, and what overshoots stands out as a speck. mix_share of what is left follows.
vec4 soft_mixed(vec4 own, vec4 soft, float more, float mix_share)
{
    vec3 white = clamp(own.rgb, 0.0, 1.0), picture = srgb_encode(white);
    vec3 splats = clamp(soft.rgb, 0.0, 1.0) + soft.a * picture;
    float gap = luma_of(splats - picture);
    float way = clamp(more * gap / (gap * gap + GAP_SURE * GAP_SURE), 0.0, 1.0);
    vec3 mixed = srgb_decode(clamp(mix(picture, splats, mix(way, 1.0, mix_share)), 0.0, 1.0));
    return vec4(mixed + own.rgb - white, own.a);
}
