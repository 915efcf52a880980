// Adds the fine part of a difference in luma to the picture, then mixes in the splats. SPECKS: specks are removed later.
#define BLOCK_SOFT
#include "shared/soft_blocks.h"
#include "soft/coarse.glsl"
#include "soft/mixed.glsl"
#include "edges/speck.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(binding = 0) uniform sampler2D differs;        // mipmapped
layout(rgba16f, binding = 1) uniform image2D picture; // linear colour, coverage
layout(rgba32f, binding = 2) readonly uniform image2D blended; // sRGB colour, what passes
#ifdef SPECKS
layout(rg8, binding = 3) uniform image2D painted; // gather/tiled.comp
#endif

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    float more = correct_share * (texelFetch(differs, at, 0).r - coarse_at(differs, at).r);
    vec4 mixed = soft_mixed(imageLoad(picture, at), imageLoad(blended, at), more, mix_share);
    imageStore(picture, at, mixed);
#ifdef SPECKS
    vec4 own = imageLoad(painted, at); // g: 0 where nothing is painted
    if (own.g > 0.0)
        imageStore(painted, at, vec4(own.r, max(speck_light(mixed.rgb), 1.0 / 255.0), 0.0, 0.0));
#endif
}
