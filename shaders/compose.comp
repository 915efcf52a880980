// The finished frame: blended colour, or the fill where nothing was blended.
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
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y)
        return;
    vec4 sum = imageLoad(accumulated, at);
    bool surface = imageLoad(depth, at).r > 0.0;
    vec4 result = vec4(0.0);
    if (sum.a > 0.0) {
        result.rgb = sum.rgb / sum.a;
        result.a = surface ? 1.0 : 0.0;
    } else {
        if (area.w == 1) { // fill
            vec4 value = fill_finer(at);
            result.rgb = value.a > 0.0 ? value.rgb / value.a : vec3(0.0);
        }
        // Splat colours between splats count as covered by them.
        result.a = surface && area.z == 1 ? 1.0 : 0.0;
    }
    imageStore(accumulated, at, result);
}
