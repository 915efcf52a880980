// Reading a photograph at a surface point; shared by the gather passes.
#define BLOCK_GATHER
#include "shared/render_blocks.h"

// Rows of struct photo_data of render_blocks.h. They are read as an image: on a software renderer
// this takes a fifth of the time of storage reads, which saves a third of the whole gather.
layout(rgba32f, binding = 7) readonly uniform imageBuffer photo_rows;

// A photograph; see struct photo_data.
struct photo {
    vec4 from_view[3], eye, focal, size, gain, lens, noise, selected;
};

// Compilers drop loads of unused members. Loads and divisions are slow: share loads between pixels
// where possible, and keep reciprocals that pixels share as separate factors, as below.
photo photo_at(int i)
{
    int row = i * ORL_PHOTO_VEC4S;
    return photo(vec4[3](imageLoad(photo_rows, row), imageLoad(photo_rows, row + 1),
                         imageLoad(photo_rows, row + 2)),
                 imageLoad(photo_rows, row + 3), imageLoad(photo_rows, row + 4),
                 imageLoad(photo_rows, row + 5), imageLoad(photo_rows, row + 6),
                 imageLoad(photo_rows, row + 7), imageLoad(photo_rows, row + 8),
                 imageLoad(photo_rows, row + 9));
}

// A point of the surface that a pixel shows.
struct Point {
    vec3 p;       // the view's camera frame; z 0: no surface
    vec3 normal;  // the same frame, towards the viewer; 0: unknown or not drawn
    bool guessed; // its depth is the estimated background depth
};

// Mipmapped. Either sRGB, which is decoded after the filter, or radiance: linear exposure *
// confidence * ORL_RADIANCE_SCALE, with the confidence weight in alpha, so that clipped pixels (confidence near
// 0) do not affect filtered neighbours.
layout(binding = 0) uniform sampler2DArray photo_color;
layout(binding = 1) uniform sampler2DArray photo_depth; // z; < 0: estimated in a hole, 0: none
// CHROMA: photo_color is the luma of sRGB, and photo_chroma its Cb and Cr at half the size.
#ifdef CHROMA
layout(binding = ORL_PHOTO_CHROMA) uniform sampler2DArray photo_chroma;
#endif
#include "gather/projection.glsl"

// The photograph's own depth at the four texels around a pixel.
vec4 photo_depths(photo source, vec2 pixel)
{
    vec2 at = pixel * (source.size.zw / source.size.xy);
    // All four texels lie in the part of the slot that the photograph covers.
    at = clamp(at, vec2(1.0), max(source.size.zw - 1.0, 1.0));
    float slot = source.eye.w;
    return textureGather(photo_depth, vec3(at * (1.0 / slot_size.zw), slot));
}

// SOFT: w is the luma that soft splats show there, so that it goes through the same filters.
#ifdef SOFT
layout(binding = ORL_PHOTO_SOFT) uniform sampler2DArray photo_soft;
#endif

vec4 photo_texel(vec2 at, float slot, float lod)
{
    vec4 texel = textureLod(photo_color, vec3(at, slot), lod);
#ifdef SOFT
    texel.a = textureLod(photo_soft, vec3(at, slot), lod).r;
#endif
    return texel;
}

// The colour of which `texel` was read: with CHROMA, luma alone was.
vec4 photo_complete(vec4 texel, vec2 pixel, float slot, float lod)
{
#ifdef CHROMA
    vec2 size = 2.0 * vec2(textureSize(photo_chroma, 0).xy);
    vec2 chroma = textureLod(photo_chroma, vec3(pixel / size, slot), lod).rg - 128.0 / 255.0;
    // The inverse of src/gpu/compress.c (ITU-R BT.601).
    vec3 color = texel.r + vec3(1.402 * chroma.g, -0.344136 * chroma.r - 0.714136 * chroma.g,
                                1.772 * chroma.r);
    return vec4(clamp(color, 0.0, 1.0), texel.a);
#else
    return texel;
#endif
}

vec4 photo_bilinear(photo source, vec2 pixel, float mip)
{
    vec4 texel = photo_texel(pixel * (1.0 / slot_size.xy), source.gain.w, mip);
    return photo_complete(texel, pixel, source.gain.w, mip);
}

#include "gather/bicubic.glsl"

filtered photo_bicubic(photo source, vec2 pixel, float mip)
{
    filtered texel = bicubic(pixel, source.gain.w, slot_size.xy, mip);
    float level = floor(mip + 0.5);
    texel.plain = photo_complete(texel.plain, pixel, source.gain.w, level);
    texel.sharp = photo_complete(texel.sharp, pixel, source.gain.w, level);
    return texel;
}
