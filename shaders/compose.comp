// The finished frame: blended colour, or the fill where nothing was blended. 2x2 pixels an
// invocation.
#define BLOCK_IMAGE
#include "include/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) uniform image2D accumulated; // in: colour * weight, weight;
                                                          // out: colour, coverage
layout(rgba32f, binding = 1) readonly uniform image2D filled;
layout(r32f, binding = 2) readonly uniform image2D depth; // < 0: guessed

#define FILL_LEVEL filled
#include "include/fill.glsl"

void main()
{
    ivec2 parent = ivec2(gl_GlobalInvocationID.xy);
    if (2 * parent.x >= area.x || 2 * parent.y >= area.y)
        return;
    vec4 finer[4];
    fill_finer(parent, finer);
    for (int k = 0; k < 4; k++) { // outside, loads give 0 and stores do nothing
        ivec2 at = 2 * parent + ivec2(k & 1, k >> 1);
        vec4 sum = imageLoad(accumulated, at);
        float on_surface = imageLoad(depth, at).r > 0.0 ? 1.0 : 0.0;
        bool fills = area.w == 1 && finer[k].a > 0.0;
        vec4 filled = vec4(fills ? finer[k].rgb / finer[k].a : vec3(0.0),
                           // Splat colours between splats count as covered by them.
                           area.z == 1 ? on_surface : 0.0);
        vec4 result = sum.a > 0.0 ? vec4(sum.rgb / sum.a, on_surface) : filled;
        // Most are as they should be where gather_best.comp painted.
        if (result != sum)
            imageStore(accumulated, at, result);
    }
}
