// Mixes the blended soft splats into the finished picture, as far as they cover it, in sRGB. Light above white
// stays.
#define BLOCK_SOFT
#include "shared/soft_blocks.h"
#include "shared/srgb.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D blended; // sRGB colour, what passes
#ifdef FINISHED
layout(rgba16f, binding = 1) uniform image2D picture; // linear colour, coverage
#else
layout(rgba32f, binding = 1) uniform image2D picture;
#endif

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    vec4 own = imageLoad(picture, at), soft = imageLoad(blended, at);
    vec3 white = clamp(own.rgb, 0.0, 1.0), encoded = srgb_encode(white);
    vec3 covered = clamp(soft.rgb, 0.0, 1.0) + soft.a * encoded;
    vec3 mixed = srgb_decode(clamp(mix(encoded, covered, mix_share), 0.0, 1.0));
    imageStore(picture, at, vec4(mixed + own.rgb - white, own.a));
}
