// Asking a photograph about a surface point, shared by the gather passes.
#ifndef PHOTO_GLSL
#define PHOTO_GLSL
#define BLOCK_GATHER
#include "shared/render_blocks.h"

// Rows of struct photo_data of render_blocks.h. Read as an image: on a software renderer a fifth
// of what storage costs, and a third of the whole gather.
layout(rgba32f, binding = 7) readonly uniform imageBuffer photo_rows;

// A photograph; see struct photo_data.
struct photo {
    vec4 from_view[3], eye, focal, size, gain, lens, noise;
};

// What is not used of it is not loaded. Loading costs: share it between pixels where that can be.
// So do divisions: here and below reciprocals that pixels share are factors of their own.
photo photo_at(int i)
{
    int row = i * ORL_PHOTO_VEC4S;
    return photo(vec4[3](imageLoad(photo_rows, row), imageLoad(photo_rows, row + 1),
                         imageLoad(photo_rows, row + 2)),
                 imageLoad(photo_rows, row + 3), imageLoad(photo_rows, row + 4),
                 imageLoad(photo_rows, row + 5), imageLoad(photo_rows, row + 6),
                 imageLoad(photo_rows, row + 7), imageLoad(photo_rows, row + 8));
}

// Mipmapped. sRGB, whose reads are linear light; with RADIANCE linear exposure * trust *
// ORL_RADIANCE_SCALE, and trust: what is clipped leaves no mark on its neighbours.
layout(binding = 0) uniform sampler2DArray photo_color;
layout(binding = 1) uniform sampler2DArray photo_depth; // z; < 0: guessed, 0: none

// Where a point of the view's camera frame lies in a photograph: pixel coordinates and z
// in its frame. False behind it or outside.
bool photo_project(photo shot, vec3 p, out vec2 pixel, out float z)
{
    vec4 ph = vec4(p, 1.0);
    vec3 q = vec3(dot(shot.from_view[0], ph), dot(shot.from_view[1], ph),
                  dot(shot.from_view[2], ph));
    z = q.z;
    pixel = vec2(-1.0);
    if (!(q.z > 0.0))
        return false;
    pixel = shot.focal.xy * q.xy * (1.0 / q.z) + shot.focal.zw;
    vec2 border = min(pixel, shot.size.xy - pixel);
    return min(border.x, border.y) > 0.5;
}

// Skies of other days, and what is not where depth is guessed, must not end in a line.
const float GUESS_BORDERS = 4.0;

// Falls from 1 to 0 towards the photograph's border.
float photo_border(photo shot, vec2 pixel, bool guessed)
{
    vec2 border = min(pixel, shot.size.xy - pixel) - 0.5;
    float width = max(guessed ? GUESS_BORDERS * options.z : options.z, 0.5);
    return clamp(min(border.x, border.y) / width, 0.0, 1.0);
}

// The photograph's own depth at the four texels around a pixel.
vec4 photo_depths(photo shot, vec2 pixel)
{
    vec2 at = pixel * (shot.size.zw / shot.size.xy);
    // Stay within the photograph's part of its slot.
    at = clamp(at, vec2(0.5), shot.size.zw - 0.5);
    float slot = shot.eye.w;
    return textureGather(photo_depth, vec3(at * (1.0 / slots.zw), slot));
}

// Mip level at which the photograph has the view's resolution.
float photo_mip(photo shot, float z, float view_depth)
{
    float magnification = shot.focal.x * view_depth / (z * view_focal.x);
    float mip = clamp(log2(magnification), 0.0, choice_more.z);
#ifdef RADIANCE
    return floor(mip + 0.5); // between levels a software renderer reads twice as much
#else
    return mip;
#endif
}

vec4 photo_texel(vec2 at, float slot, float lod)
{
    return textureLod(photo_color, vec3(at, slot), lod);
}

vec4 photo_bilinear(photo shot, vec2 pixel, float mip)
{
    return photo_texel(pixel * (1.0 / slots.xy), shot.gain.w, mip);
}

// Catmull-Rom from bilinear fetches (Sigg and Hadwiger 2005): bilinear sampling would
// blur every photograph by the phase that it happens to be met at.
vec4 photo_bicubic(photo shot, vec2 pixel, float mip)
{
    float lod = floor(mip + 0.5), slot = shot.gain.w;
    vec2 size_at = max(floor(slots.xy / exp2(lod)), vec2(1.0));
    vec2 at = pixel / slots.xy * size_at - 0.5;
    vec2 base = floor(at), f = at - base;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 w3 = f * f * (-0.5 + 0.5 * f);
    vec2 w12 = w1 + w2;
    vec2 p0 = (base - 0.5) / size_at, p3 = (base + 2.5) / size_at;
    vec2 p12 = (base + 0.5 + w2 / w12) / size_at;
    vec4 sum = photo_texel(vec2(p12.x, p0.y), slot, lod) * (w12.x * w0.y) +
               photo_texel(vec2(p0.x, p12.y), slot, lod) * (w0.x * w12.y) +
               photo_texel(p12, slot, lod) * (w12.x * w12.y) +
               photo_texel(vec2(p3.x, p12.y), slot, lod) * (w3.x * w12.y) +
               photo_texel(vec2(p12.x, p3.y), slot, lod) * (w12.x * w3.y);
    float total = w12.x * w0.y + w0.x * w12.y + w12.x * w12.y + w3.x * w12.y + w12.x * w3.y;
    // The four corners, left out, weigh next to nothing.
    return max(sum / total, 0.0);
}

// Linear colour times gain; a: factor on the weight of this sample, 1 without RADIANCE.
#ifdef RADIANCE
const float SHARPEN_MAX = 1.5;

vec4 photo_radiance(photo shot, vec2 pixel, float mip)
{
    vec4 texel = photo_bilinear(shot, pixel, mip);
    vec3 exposure = texel.rgb / (ORL_RADIANCE_SCALE * max(texel.a, 1e-8));
    return vec4(exposure * shot.gain.rgb, texel.a);
}

// What is `color` by photo_radiance, sharper. Where contrasts are high, or trust falls, the
// negative lobes of this filter ring far below black: it changes by a factor, no more.
vec3 photo_sharper(photo shot, vec2 pixel, float mip, vec3 color)
{
    vec4 texel = photo_bicubic(shot, pixel, mip);
    if (!(texel.a > 1e-8))
        return color;
    vec3 sharper = texel.rgb / (ORL_RADIANCE_SCALE * texel.a) * shot.gain.rgb;
    return clamp(sharper, color / SHARPEN_MAX, color * SHARPEN_MAX);
}
#else
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
#endif

// Does none of these depths lie clearly in front of z? For points only known to be
// behind everything else.
bool photo_unhidden(vec4 seen, float z, float tolerance)
{
    return !any(bvec4(seen.x > 0.0 && seen.x < z - tolerance,
                      seen.y > 0.0 && seen.y < z - tolerance,
                      seen.z > 0.0 && seen.z < z - tolerance,
                      seen.w > 0.0 && seen.w < z - tolerance));
}

#endif
