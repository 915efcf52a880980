// Writes the occluders of a photograph into its depth map, nearer than all else.
#define BLOCK_DEPTH_MAP
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(binding = 0) uniform sampler2D mask; // 1: shows an occluder; of any size
layout(binding = 0) writeonly uniform image2D depth;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= kept_size.x || at.y >= kept_size.y)
        return;
    if (textureLod(mask, (vec2(at) + 0.5) / vec2(kept_size), 0.0).r > 0.5)
        imageStore(depth, at, vec4(occluder_depth));
}
