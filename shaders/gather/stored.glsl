// Colours of photographs as textures hold them, for the renderer and for the page: sRGB, which is decoded after the
// filter. RADIANCE: photographs are radiance, which needs no decoding.
#include "shared/srgb.glsl"

// The light of a colour.
vec3 stored_light(vec3 stored)
{
#ifdef RADIANCE
    return stored;
#else
    return srgb_decode(stored);
#endif
}

// The mean of four. The square of an sRGB value, or of its luma, is nearly proportional to light.
vec4 stored_mean(vec4 a, vec4 b, vec4 c, vec4 d)
{
#ifdef RADIANCE
    return 0.25 * (a + b + c + d);
#else
    return sqrt(0.25 * (a * a + b * b + c * c + d * d));
#endif
}
