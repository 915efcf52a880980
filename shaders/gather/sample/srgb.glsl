// Samples of photographs as they are: linear light, at the scene's exposure where aligned.
// BICUBIC: by Catmull-Rom, else bilinear.
#include "gather/photo.glsl"

// Brings linear colour to the scene's exposure and white balance, the lens's fall-off undone.
// Linear for all but the brightest; white stays white, as a photograph that clipped was at
// least that bright, and cameras compress what is near. src/render/reexpose.c undoes it.
vec3 photo_aligned(photo shot, vec2 pixel, vec3 color)
{
    vec2 off = pixel - shot.focal.zw;
    vec3 lens = shot.lens.xyz;
    float r2 = dot(off, off) * shot.lens.w;
    float light = 1.0 + r2 * (lens.x + r2 * (lens.y + r2 * lens.z));
    vec3 gain = shot.gain.rgb / max(light, 0.1);
    // As much of the third power, and of the first for the rest, as leaves brighter brighter.
    vec3 more = gain - 1.0, third = min(more, vec3(0.5)), c = min(color, vec3(1.0));
    return gain * color / (1.0 + c * (more - third + third * c * c));
}

// Colour, and trust: all of it.
vec4 photo_sample(photo shot, vec2 pixel, float mip)
{
    // A program for each: software renderers run both sides of a condition.
#ifdef BICUBIC
    vec3 color = photo_bicubic(shot, pixel, mip).rgb;
#else
    // Levels blend in a narrow range only: a software renderer reads both of them there, and
    // elsewhere one, the sharper one more often than not.
    float level = floor(mip);
    level += clamp(5.0 * (mip - level) - 3.5, 0.0, 1.0);
    vec3 color = photo_bilinear(shot, pixel, level).rgb;
#endif
    return vec4(photo_aligned(shot, pixel, color), 1.0);
}
