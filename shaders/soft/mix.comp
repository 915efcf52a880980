// Adds the fine part of a difference in luma to the picture, then mixes in the splats as far as they cover it, in sRGB.
// Light above white stays.
#include "soft/coarse.glsl"
#include "shared/srgb.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(binding = 0) uniform sampler2D differs;        // mipmapped
layout(rgba16f, binding = 1) uniform image2D picture; // linear colour, coverage
layout(rgba32f, binding = 2) readonly uniform image2D blended; // sRGB colour, what passes

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    vec4 own = imageLoad(picture, at), soft = imageLoad(blended, at);
    vec3 white = clamp(own.rgb, 0.0, 1.0);
    float more = correct_share * (texelFetch(differs, at, 0).r - coarse_at(differs, at).r);
    vec3 corrected = clamp(srgb_encode(white) + more, 0.0, 1.0);
    vec3 covered = clamp(soft.rgb, 0.0, 1.0) + soft.a * corrected;
    vec3 mixed = srgb_decode(clamp(mix(corrected, covered, mix_share), 0.0, 1.0));
    imageStore(picture, at, vec4(mixed + own.rgb - white, own.a));
}
