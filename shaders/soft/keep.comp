// Keeps what soft splats show in a photograph. Beyond the photograph, its slot takes what they show at the border.
#define BLOCK_SOFT
#include "shared/soft_blocks.h"
#include "soft/shown.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(binding = 0) uniform sampler2D blended; // as shown.glsl has it
layout(r8, binding = 0) writeonly uniform image2D slot;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(slot))))
        imageStore(slot, at, vec4(shown_at(blended, min(at, view_size - 1))));
}
