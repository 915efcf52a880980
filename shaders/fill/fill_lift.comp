// Gives pixels of which only the least light is known the light around them that is as bright,
// which fill_seed.comp and its like have spread as logarithms: these are known then. 2x2 pixels an invocation.
#define BLOCK_IMAGE
#include "shared/pixel.glsl"
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D filled;
layout(rgba32f, binding = 1) uniform image2D accumulated; // shared/pixel.glsl, blended

#define FILL_LEVEL filled
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
        vec4 sum = imageLoad(accumulated, at);
        if (!pixel_at_least(sum) || !(finer[k].a > 0.0))
            continue;
        float weight = pixel_weight(sum);
        vec3 light = exp2(finer[k].rgb / finer[k].a);
        imageStore(accumulated, at, pixel_blended(max(sum.rgb, light * weight), weight, false));
    }
}
