// A pixel that soft splats correct and are mixed into, as far as they cover it, in sRGB. Light above white stays.
#include "shared/srgb.glsl"

// own: linear colour, coverage; soft: sRGB colour of the splats, what passes; more: in luma of sRGB.
vec4 soft_mixed(vec4 own, vec4 soft, float more, float mix_share)
{
    vec3 white = clamp(own.rgb, 0.0, 1.0);
    vec3 corrected = clamp(srgb_encode(white) + more, 0.0, 1.0);
    vec3 covered = clamp(soft.rgb, 0.0, 1.0) + soft.a * corrected;
    vec3 mixed = srgb_decode(clamp(mix(corrected, covered, mix_share), 0.0, 1.0));
    return vec4(mixed + own.rgb - white, own.a);
}
