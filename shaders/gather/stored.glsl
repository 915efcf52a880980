// Colours of photographs as textures hold them, for the renderer and for the page: sRGB, which the file that reads them
// decodes after the filter, or with RADIANCE radiance.
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

// The mean of four. The squares of sRGB are about as light, and those of its luma too.
vec4 stored_mean(vec4 a, vec4 b, vec4 c, vec4 d)
{
#ifdef RADIANCE
    return 0.25 * (a + b + c + d);
#else
    return sqrt(0.25 * (a * a + b * b + c * c + d * d));
#endif
}
