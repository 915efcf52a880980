// A pixel whose light is only a lower bound takes the equally bright light around it, and is then
// known. fill_seed.comp and the passes after it have spread that light as logarithms. One
// invocation handles 2x2 pixels.
#define BLOCK_IMAGE
#include "shared/pixel.glsl"
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D filled;
layout(rgba32f, binding = 1) uniform image2D accumulated; // blended pixels of shared/pixel.glsl

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
