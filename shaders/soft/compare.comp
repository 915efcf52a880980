// How far what soft splats show in the view differs from what they show in the photographs that each pixel was blended
// from. Where the surface is right, both are the same.
#define BLOCK_SOFT
#include "shared/soft_blocks.h"
#include "soft/shown.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(binding = 0) uniform sampler2D blended; // as shown.glsl has it
layout(r16f, binding = 0) readonly uniform image2D gathered; // luma in the photographs; < 0: there are none
layout(r16f, binding = 1) writeonly uniform image2D differs;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    float other = imageLoad(gathered, at).r;
    imageStore(differs, at, vec4(other < 0.0 ? 0.0 : shown_at(blended, at) - other));
}
