// Keeps what soft splats show in a photograph. Beyond the photograph, its slot takes what they show at the border.
#include "soft/shown.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r8, binding = 0) writeonly uniform image2D slot;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(slot))))
        imageStore(slot, at, vec4(shown_at(min(at, view_size - 1))));
}
