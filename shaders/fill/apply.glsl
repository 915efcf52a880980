// What a level of the pyramid of hole filling says of the pixels of an image of twice the size. The including file
// defines fill_pixel. One invocation handles 2x2 pixels.
// FAR: the values are those of fill/slope.glsl.
#define BLOCK_IMAGE
#include "shared/render_blocks.h"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D filled;
#include "fill/fill.glsl"

void fill_pixel(ivec2 at, vec4 value); // value.a: 0: nothing is known

void main()
{
    ivec2 parent = ivec2(gl_GlobalInvocationID.xy);
    if (2 * parent.x >= image_size.x || 2 * parent.y >= image_size.y)
        return;
    vec4 finer[4];
    fill_finer(parent, finer);
    for (int k = 0; k < 4; k++) // outside, loads give 0 and stores do nothing
        fill_pixel(2 * parent + ivec2(k & 1, k >> 1), finer[k]);
}
