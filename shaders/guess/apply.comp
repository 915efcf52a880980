// Moves the estimated background depth of open cells.
#define BLOCK_GATHER
#include "shared/render_blocks.h"
#include "guess/cells.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) uniform image2D view_depth;      // < 0: estimated background depth
layout(r32f, binding = 2) readonly uniform image2D picked; // share of inverse depth; 1: unmoved

float share_of(ivec2 cell)
{
    return imageLoad(picked, clamp(cell, ivec2(0), cells_across_down() - 1)).r;
}

#include "guess/apply.glsl"

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, cells_across_down())))
        return;
    float own = imageLoad(picked, cell).r;
    int k = 0, pixels = own < 1.0 ? CELL * CELL : 0;
    do { // the condition comes last: see gather/tiled.comp
        ivec2 at = CELL * cell + ivec2(k % CELL, k / CELL);
        float depth = imageLoad(view_depth, at).r; // 0 outside
        if (depth < 0.0 && own < 1.0)
            imageStore(view_depth, at, vec4(moved(at, depth)));
        k++;
    } while (k < pixels);
}
