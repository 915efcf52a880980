// Samples photographs as linear light, brought to the scene's exposure where photographs are
// aligned. BICUBIC: with a Catmull-Rom filter, else bilinear. Filters take sRGB as it is stored: a bright pixel beside
// dark ones spreads less than in linear light.
#include "gather/photo.glsl"

// Brings linear colour to the scene's exposure and white balance and undoes the vignetting. The
// mapping is linear except for the brightest colours. White stays white, since a clipped photograph
// was at least that bright, and cameras compress highlights. src/render/output/reexpose.c inverts it.
vec3 photo_aligned(photo source, vec2 pixel, vec3 color)
{
    vec2 off = pixel - source.focal.zw;
    vec3 lens = source.lens.xyz;
    float r2 = dot(off, off) * source.lens.w;
    float light = 1.0 + r2 * (lens.x + r2 * (lens.y + r2 * lens.z));
    vec3 gain = source.gain.rgb / max(light, 0.1);
    // Mixes the first and the third power of the colour such that the mapping stays increasing.
    vec3 more = gain - 1.0, third = min(more, vec3(0.5)), c = min(color, vec3(1.0));
    return gain * color / (1.0 + c * (more - third + third * c * c));
}

// The aligned light of sRGB as it is stored.
vec3 photo_light(photo source, vec2 pixel, vec3 stored)
{
    return photo_aligned(source, pixel, stored_light(stored));
}

// Colour, and w of photo_texel.
vec4 photo_filtered(photo source, vec2 pixel, float mip)
{
    // Each filter is a program of its own, since software renderers run both sides of a condition.
#ifdef BICUBIC
    vec4 texel = photo_bicubic(source, pixel, mip).sharp;
#else
    // Mip levels are interpolated only in a narrow range, where a software renderer reads two
    // levels.
    // Elsewhere it reads one, which is more often the sharper one.
    float level = floor(mip);
    level += clamp(5.0 * (mip - level) - 3.5, 0.0, 1.0);
    vec4 texel = photo_bilinear(source, pixel, level);
#endif
    return vec4(photo_light(source, pixel, texel.rgb), texel.a);
}

// Colour, and full confidence.
vec4 photo_sample(photo source, vec2 pixel, float mip)
{
    return vec4(photo_filtered(source, pixel, mip).rgb, 1.0);
}

// The sample of the k-th best photograph, from 0, and w of photo_texel. The best one is read with the filter that is
// asked for, the others with one fetch. Set for k = 0 with the bicubic filter: detail, what it adds, as a share of the
// sample without it; varies, how much the photograph varies about the place.
vec4 photo_ranked(photo source, int k, vec2 pixel, float mip, inout vec4 detail, inout float varies)
{
#ifdef BICUBIC
    if (k > 0) { // the level whose bilinear sample is about as wide as a pixel of the view: see AREA_FROM
        vec4 texel = photo_bilinear(source, pixel, floor(max(mip - 0.3, 0.0)));
        return vec4(photo_light(source, pixel, texel.rgb), texel.a);
    }
    filtered texel = photo_bicubic(source, pixel, mip);
    vec4 plain = vec4(stored_light(texel.plain.rgb), texel.plain.a);
    vec4 sharp = vec4(stored_light(texel.sharp.rgb), texel.sharp.a);
    varies = texel.varies;
    detail = (sharp - plain) / max(plain, 1e-9);
    return vec4(photo_aligned(source, pixel, sharp.rgb), sharp.a);
#else
    return photo_filtered(source, pixel, mip);
#endif
}
