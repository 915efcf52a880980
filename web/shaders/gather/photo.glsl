// Asking a photograph about a surface point: what shaders/gather/photo.glsl is for compute, for
// WebGL 2. The files of shaders/gather that stand on it are the same for both.
uniform sampler2D photo_rows; // a row of 9 texels for each photograph of the frame
// Mipmapped: sRGB, decoded after the filter, or radiance. a: what soft splats show there, luma, once it is loaded.
uniform mediump sampler2DArray photo_color;
uniform sampler2DArray photo_depth; // in units of file.y; < 0: guessed, 0: none
uniform vec4 view_focal;
uniform float border_px, last_mip, blur_per_radian;
uniform vec2 slot_size; // of photo_color, pixels
uniform vec4 ground;    // dot(xyz, ray) is its inverse depth
uniform struct {
    float depth_tolerance, sharpness;
} opt;

const float NOT_SEEN = 1e30; // penalty of a photograph that cannot paint a pixel

struct photo {
    vec4 from_view[3]; // rows: rotation | translation, photograph's camera from the view's
    vec4 eye;          // its centre in the view's camera frame; w: slot
    vec4 focal;
    vec4 size;         // width, height; of its depth
    vec4 gain;
    vec4 lens;         // relative illumination: factors of r^2, r^4, r^6; w: r^2 per pixel^2
    vec4 file;         // number among all photographs, unit of its depth
};

photo photo_at(int i)
{
    return photo(vec4[3](texelFetch(photo_rows, ivec2(0, i), 0), texelFetch(photo_rows, ivec2(1, i), 0),
                         texelFetch(photo_rows, ivec2(2, i), 0)),
                 texelFetch(photo_rows, ivec2(3, i), 0), texelFetch(photo_rows, ivec2(4, i), 0),
                 texelFetch(photo_rows, ivec2(5, i), 0), texelFetch(photo_rows, ivec2(6, i), 0),
                 texelFetch(photo_rows, ivec2(7, i), 0), texelFetch(photo_rows, ivec2(8, i), 0));
}

// Number c of a tile's list (choose.frag); -1: there are no more.
int photo_listed(uvec2 list, int c)
{
    uint i = (c < 4 ? list.x : list.y) >> uint(8 * (c & 3)) & 255u;
    return i == 255u ? -1 : int(i);
}

#include "gather/projection.glsl"

// The photograph's own depth at the four texels around a pixel.
vec4 photo_depths(photo source, vec2 pixel)
{
    vec2 at = clamp(pixel * source.size.zw / source.size.xy, vec2(0.5), source.size.zw - 0.5);
    ivec2 low = ivec2(floor(at - 0.5)), high = min(low + 1, ivec2(source.size.zw) - 1);
    int slot = int(source.eye.w);
    return source.file.y * vec4(texelFetch(photo_depth, ivec3(low, slot), 0).x,
                                texelFetch(photo_depth, ivec3(high.x, low.y, slot), 0).x,
                                texelFetch(photo_depth, ivec3(low.x, high.y, slot), 0).x,
                                texelFetch(photo_depth, ivec3(high, slot), 0).x);
}

vec4 photo_texel(vec2 at, float slot, float lod)
{
    return textureLod(photo_color, vec3(at, slot), lod);
}

vec4 photo_bilinear(photo source, vec2 pixel, float mip)
{
    return photo_texel(pixel / slot_size, source.eye.w, mip);
}

#include "gather/bicubic.glsl"

filtered photo_bicubic(photo source, vec2 pixel, float mip)
{
    return bicubic(pixel, source.eye.w, slot_size, mip);
}
