// A photograph's depth map, which may be kept at a smaller size than it was drawn at. Each texel is one that was
// drawn, since a mean of depths on both sides of an outline is on neither surface. The including file defines
// kept_depth.
#define BLOCK_DEPTH_MAP
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D depth;
layout(binding = 1) writeonly uniform image2D kept;

// 0: none, and outside.
float known(ivec2 at)
{
    return imageLoad(depth, at).r;
}

float kept_depth(ivec2 at); // of a texel that was drawn

void main()
{
    ivec2 to = ivec2(gl_GlobalInvocationID.xy);
    if (to.x >= kept_size.x || to.y >= kept_size.y)
        return;
    ivec2 at = min(ivec2((vec2(to) + 0.5) * vec2(drawn_size) / vec2(kept_size)), drawn_size - 1);
    imageStore(kept, to, vec4(kept_depth(at)));
}
