// Writes guessed background depth, negative, where the proxy has none: what is known around, but
// no farther than the ground (Li's room, of which only the floor is sure). 2x2 pixels an
// invocation.
#define BLOCK_IMAGE
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D filled;
layout(r32f, binding = 1) uniform image2D depth;

#define FILL_LEVEL filled
#include "fill/fill.glsl"

// Inverse depth; 0: no ground there.
float on_ground(ivec2 at)
{
    float inverse = dot(ground.xyz, vec3((vec2(at) + 0.5 - focal.zw) / focal.xy, 1.0));
    return inverse > ground.w ? inverse : 0.0;
}

void main()
{
    ivec2 parent = ivec2(gl_GlobalInvocationID.xy);
    if (2 * parent.x >= image_size.x || 2 * parent.y >= image_size.y)
        return;
    vec4 finer[4];
    fill_finer(parent, finer);
    for (int k = 0; k < 4; k++) { // outside, loads give 0 and stores do nothing
        ivec2 at = 2 * parent + ivec2(k & 1, k >> 1);
        if (finer[k].r > 0.0 && !(imageLoad(depth, at).r > 0.0))
            imageStore(depth, at, vec4(-1.0 / max(finer[k].r / finer[k].a, on_ground(at))));
    }
}
