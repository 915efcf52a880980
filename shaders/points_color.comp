// The `points` method: pixels whose own splat is in front take its colour.
#define BLOCK_IMAGE
#include "include/render_blocks.h"
#include "include/srgb.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(std430, binding = 1) readonly buffer pixel_depth {
    uint depth_bits[];
};
layout(rgba32f, binding = 0) readonly uniform image2D surfel_a;
layout(rgba8, binding = 1) readonly uniform image2D splat_color;
layout(rgba32f, binding = 2) writeonly uniform image2D accumulated;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y)
        return;
    // The push stage brings pixels forward where it finds their splat occluded.
    vec4 color = imageLoad(splat_color, at);
    float nearest = uintBitsToFloat(depth_bits[at.y * area.x + at.x]);
    if (color.a > 0.0 && imageLoad(surfel_a, at).x >= nearest)
        imageStore(accumulated, at, vec4(srgb_decode(color.rgb), 1.0));
}
