// Fattens the outlines of a depth map by FATTEN_PX pixels, as Li 2003, 5.2.2 does by drawing
// edges as thick lines first: a line lies farther back than its surface by a larger offset than the
// shadow test allows, so that it covers what is behind an outline and not the surface beside it.
#define BLOCK_FATTEN
#include "shared/hull_blocks.h"
#include "proxy/kept.glsl"

const int FATTEN_PX = 2;

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D depth;
layout(r32f, binding = 1) writeonly uniform image2D fattened;

void main()
{
    ivec2 to = ivec2(gl_GlobalInvocationID.xy);
    if (to.x >= kept_size.x || to.y >= kept_size.y)
        return;
    ivec2 at = drawn_texel(to, drawn_size, kept_size);
    float here = imageLoad(depth, at).r, line = 1e30;
    for (int y = -FATTEN_PX; y <= FATTEN_PX; y++)
        for (int x = -FATTEN_PX; x <= FATTEN_PX; x++) {
            float found = imageLoad(depth, at + ivec2(x, y)).r; // 0 outside
            bool reaches = x * x + y * y <= FATTEN_PX * FATTEN_PX && found > 0.0;
            line = min(line, reaches ? found * line_offset : 1e30);
        }
    float nearest = min(here > 0.0 ? here : 1e30, line);
    imageStore(fattened, to, vec4(nearest < 1e30 ? nearest : 0.0));
}
