// Estimates depth in the holes of a photograph's depth map.
#define BLOCK_HOLES
#include "shared/render_blocks.h"
#include "proxy/kept.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D depth;
layout(binding = 1) writeonly uniform image2D guessed; // the same depth, with estimates

float known(ivec2 at)
{
    return imageLoad(depth, at).r;
}

#include "proxy/holes.glsl"

void main()
{
    ivec2 to = ivec2(gl_GlobalInvocationID.xy);
    if (to.x >= kept_size.x || to.y >= kept_size.y)
        return;
    ivec2 at = drawn_texel(to, drawn_size, kept_size);
    float here = known(at);
    if (here > 0.0) {
        imageStore(guessed, to, vec4(here));
        return;
    }
    imageStore(guessed, to, vec4(hole_depth(at, drawn_size)));
}
