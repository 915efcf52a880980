// The luma of sRGB that soft splats show in a pixel. What passes all of them is as what they show around
// it. blended: mipmapped; sRGB colour, what passes.
#include "soft/coarse.glsl"
#include "soft/luma.glsl"

float shown_at(sampler2D blended, ivec2 at)
{
    vec4 own = texelFetch(blended, at, 0), around = coarse_at(blended, at);
    vec3 color = own.rgb + own.a * around.rgb / max(1.0 - around.a, 1e-3);
    return clamp(luma_of(color), 0.0, 1.0);
}
