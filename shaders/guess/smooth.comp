// Takes the paths of one direction along each line of cells and sums their costs over the directions. ALONG:
// direction, 0 to 3; the first one begins the sums.
#define BLOCK_GATHER
#include "shared/render_blocks.h"
#include "guess/cells.glsl"
#include "guess/path.glsl"

layout(local_size_x = 32) in;
layout(std430, binding = 3) readonly buffer plane_costs {
    float costs[];
};
layout(std430, binding = 4) buffer path_costs {
    float sums[];
};

void main()
{
    int line = int(gl_GlobalInvocationID.x), length = ALONG < 2 ? cells_across_down().x
                                                                : cells_across_down().y;
    if (line >= (ALONG < 2 ? cells_across_down().y : cells_across_down().x))
        return;
    float own[PLANES], path[PLANES], least = 0.0;
    for (int k = 0; k < PLANES; k++)
        path[k] = 0.0;
    for (int s = 0; s < length; s++) {
        int at = (ALONG & 1) == 0 ? s : length - 1 - s, row = first_cost(ALONG < 2 ? ivec2(at, line)
                                                                                 : ivec2(line, at));
        for (int k = 0; k < PLANES; k++)
            own[k] = costs[row + k];
        path_step(own, path, least);
        for (int k = 0; k < PLANES; k++)
            sums[row + k] = path[k] + (ALONG == 0 ? 0.0 : sums[row + k]);
    }
}
