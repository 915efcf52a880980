// The pictures of two photographs on a billboard, premultiplied by alpha (Goldluecke 2003, section
// 3). RADIANCE: photographs are radiance. TABLES: projections come from tables of as many bits as
// opt.projection_bits.
#include "gather/photo.glsl"

#ifdef RADIANCE
#include "gather/sample/radiance.glsl"
#include "gather/radiance/alone.glsl"
#else
#include "gather/sample/srgb.glsl"
#endif

layout(binding = 2) uniform sampler2DArray photo_mask; // 1: the subject
layout(location = 0) in vec3 in_camera;
layout(location = 1) flat in uint painted_by;
layout(location = 2) flat in float second_weight;
layout(location = 0) out vec4 painted;

#ifdef TABLES
// The paper stores the projection of every voxel's centre in a 3D texture of 8-bit channels, which
// the hardware interpolates. This gives the same without the texture.
bool project(photo source, vec3 p, out vec2 pixel, out float z)
{
    bool inside = photo_project(source, p, pixel, z);
    vec4 ph = vec4(p, 1.0);
    vec3 at = vec3(dot(local_from_view[0], ph), dot(local_from_view[1], ph),
                   dot(local_from_view[2], ph));
    vec3 low = clamp(floor(at - 0.5), vec3(0.0), vec3(voxel_side - 2));
    vec3 share = clamp(at - 0.5 - low, 0.0, 1.0);
    float steps = exp2(opt.projection_bits) - 1.0;
    vec2 sum = vec2(0.0);
    for (int k = 0; k < 8; k++) {
        vec3 corner = vec3(k & 1, k >> 1 & 1, k >> 2), off = low + 0.5 + corner - at;
        vec3 from = p + voxel * voxel * (off.x * local_from_view[0].xyz +
                                         off.y * local_from_view[1].xyz +
                                         off.z * local_from_view[2].xyz);
        vec3 weight = mix(1.0 - share, share, corner);
        vec2 there;
        float depth;
        photo_project(source, from, there, depth);
        vec2 stored = floor(clamp(there / source.size.xy, 0.0, 1.0) * steps + 0.5) / steps;
        sum += weight.x * weight.y * weight.z * stored;
    }
    pixel = sum * source.size.xy;
    return inside;
}
#else
bool project(photo source, vec3 p, out vec2 pixel, out float z)
{
    return photo_project(source, p, pixel, z);
}
#endif

// Colour, and alpha: how far the pixel is the subject's. confidence: in the colour, by exposure.
vec4 picture_of(uint row, out float confidence)
{
    photo source = photo_at(int(row));
    vec2 pixel;
    float z;
    confidence = 0.0;
    if (!project(source, in_camera, pixel, z))
        return vec4(0.0);
    float mip = photo_mip(source, z, in_camera.z);
    float alpha = textureLod(photo_mask, vec3(pixel / slot_size.xy, source.eye.w), mip).r;
    vec4 color = photo_sample(source, pixel, mip);
#ifdef RADIANCE
    confidence = color.a > 0.0 ? confidence_alone(source, color) : 0.0;
#else
    confidence = 1.0;
#endif
    return vec4(color.rgb, color.a > 0.0 ? alpha : 0.0);
}

void main()
{
    float trust, second_trust;
    vec4 first = picture_of(painted_by & 0xffffu, trust), second = vec4(0.0);
    float share = second_weight;
    if (second_weight > 0.0) {
        second = picture_of(painted_by >> 16, second_trust);
        // Where exposures differ, both weights count by confidence: with equal ones share stays.
        float mine = share * second_trust, all = (1.0 - share) * trust + mine;
        share = all > 0.0 ? mine / all : share;
    }
    float over = share * second.a;
    painted = vec4(first.rgb * (first.a * (1.0 - over)) + second.rgb * over,
                   first.a * (1.0 - over) + over);
}
