// Semi-global matching (Hirschmueller 2008, equation 13) in one direction: the least cost of a path
// of open cells that ends at a cell and a plane. The sums are over the directions. ALONG:
// direction, 0 to 3; the first one begins the sums.
#define BLOCK_GATHER
#include "shared/render_blocks.h"
#include "guess/planes.glsl"

layout(local_size_x = GUESS_LINES) in;
layout(std430, binding = 3) readonly buffer plane_costs {
    float costs[];
};
layout(std430, binding = 4) buffer path_costs {
    float sums[];
};

// Cost of a step to the next plane, and of a greater one.
const float STEP = 0.05, JUMP = 0.4;

void main()
{
    int line = int(gl_GlobalInvocationID.x), length = ALONG < 2 ? cells_across_down().x
                                                                : cells_across_down().y;
    if (line >= (ALONG < 2 ? cells_across_down().y : cells_across_down().x))
        return;
    float before[PLANES], now[PLANES], least = 0.0;
    for (int k = 0; k < PLANES; k++)
        before[k] = 0.0;
    for (int s = 0; s < length; s++) {
        int at = (ALONG & 1) == 0 ? s : length - 1 - s, row = first_cost(ALONG < 2 ? ivec2(at, line)
                                                                                 : ivec2(line, at));
        bool closed = costs[row] == CLOSED; // the path begins anew behind it
        float next = 1e30;
        for (int k = 0; k < PLANES; k++) {
            float best = min(min(before[k], least + JUMP),
                             min(before[max(k - 1, 0)], before[min(k + 1, PLANES - 1)]) + STEP);
            now[k] = closed ? 0.0 : costs[row + k] + best - least;
            next = min(next, now[k]);
            sums[row + k] = now[k] + (ALONG == 0 ? 0.0 : sums[row + k]);
        }
        for (int k = 0; k < PLANES; k++)
            before[k] = now[k];
        least = next;
    }
}
