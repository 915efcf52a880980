// The luma (ITU-R BT.601, of sRGB) that soft splats show in a pixel. What passes all of them is as what they show around
// it. blended: mipmapped; sRGB colour, what passes.
#include "soft/coarse.glsl"

float shown_at(sampler2D blended, ivec2 at)
{
    vec4 own = texelFetch(blended, at, 0), around = coarse_at(blended, at);
    vec3 color = own.rgb + own.a * around.rgb / max(1.0 - around.a, 1e-3);
    return clamp(dot(color, vec3(0.299, 0.587, 0.114)), 0.0, 1.0);
}
