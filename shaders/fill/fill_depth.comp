// Writes the estimated background depth, as a negative value, where the proxy has none. It continues
// the surfaces around the pixel, but no farther than the ground (the floor of Li's room box, its
// only reliable side). One invocation handles 2x2 pixels.
#define BLOCK_IMAGE
#include "shared/constants.h"
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D filled;
layout(r32f, binding = 1) uniform image2D depth;

#define FILL_LEVEL filled
#define FAR
#include "fill/fill.glsl"

void main()
{
    ivec2 parent = ivec2(gl_GlobalInvocationID.xy);
    if (2 * parent.x >= image_size.x || 2 * parent.y >= image_size.y)
        return;
    vec4 finer[4];
    fill_finer(parent, finer);
    for (int k = 0; k < 4; k++) { // outside, loads give 0 and stores do nothing
        ivec2 at = 2 * parent + ivec2(k & 1, k >> 1);
        vec3 ray = vec3((vec2(at) + 0.5 - focal.zw) / focal.xy, 1.0);
        if (finer[k].a > 0.0 && !(imageLoad(depth, at).r > 0.0))
            imageStore(depth, at, vec4(slope_guess(finer[k], 1.0 / (ORL_GUESS_FARTHEST * depth_scale), ground, ray)));
    }
}
