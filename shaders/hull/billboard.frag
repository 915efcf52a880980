// The pictures of two photographs on a billboard, premultiplied by alpha (Goldluecke 2003, section
// 3). RADIANCE: photographs are radiance.
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

// Colour, and alpha: how far the pixel is the subject's. confidence: in the colour, by exposure.
vec4 picture_of(uint row, out float confidence)
{
    photo source = photo_at(int(row));
    vec2 pixel;
    float z;
    confidence = 0.0;
    if (!photo_project(source, in_camera, pixel, z))
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
