// Fills pixels without a value bilinearly from the coarser level (Gortler 1996, push). One
// invocation handles 2x2 pixels.
// FAR: the values are those of fill/slope.glsl.
#define BLOCK_IMAGE
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) uniform image2D fine;
layout(rgba32f, binding = 1) readonly uniform image2D coarse;

#define FILL_LEVEL coarse
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
        vec4 own = imageLoad(fine, at);
        if (finer[k].a > 0.0 && !(own.a > 0.0))
            imageStore(fine, at, finer[k]);
    }
}
