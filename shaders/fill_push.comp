// Fills pixels that know nothing from the coarser level, bilinearly (Gortler 1996, push).
#define BLOCK_IMAGE
#include "include/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) uniform image2D fine;
layout(rgba32f, binding = 1) readonly uniform image2D coarse;

#define FILL_LEVEL coarse
#include "include/fill.glsl"

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= area.x || at.y >= area.y || imageLoad(fine, at).a > 0.0)
        return;
    vec4 sum = fill_finer(at);
    if (sum.a > 0.0)
        imageStore(fine, at, sum);
}
