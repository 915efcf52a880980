// Lists the pixels at depth discontinuities, each with an antialiasing strength in (0, 1]; in a
// photograph such a pixel shows both sides. The strength follows the variance of what a photograph's
// lens and pixels blur, in pixels of the view. antialias.comp then averages the listed pixels. One
// invocation handles 2x2 pixels.
#define BLOCK_IMAGE
#include "shared/render_blocks.h"
#include "edges/edge_list.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D depth; // < 0: estimated background depth

// Second difference of inverse depth between pixels of photographs, as a fraction of the largest
// inverse depth, at which antialiasing begins and at which it is full. The second difference of a
// plane is zero, and that of a curved surface grows with the square of a pixel's width.
const float STEP_FROM = 0.004, STEP_FULL = 0.012;

void main()
{
    ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (corner.x >= image_size.x || corner.y >= image_size.y)
        return;
    float inverse[16]; // of the 4x4 pixels around; 0: estimated depth, behind everything
    for (int k = 0; k < 16; k++) {
        float z = imageLoad(depth, corner + ivec2(k & 3, k >> 2) - 1).r;
        inverse[k] = z > 0.0 ? 1.0 / z : 0.0;
    }
    float area = footprint * footprint;
    const int along[4] = int[4](1, 3, 4, 5); // index offsets to the next pixel in four directions
    for (int k = 0; k < 4; k++) {
        ivec2 at = corner + ivec2(k & 1, k >> 1);
        bool whole = all(greaterThan(at, ivec2(0))) && all(lessThan(at, image_size - 1));
        int own = 5 + (k & 1) + 4 * (k >> 1);
        float bend = 0.0, most = inverse[own];
        for (int n = 0; n < 4; n++) {
            float before = inverse[own - along[n]], after = inverse[own + along[n]];
            bend = max(bend, abs(before + after - 2.0 * inverse[own]));
            most = max(most, max(before, after));
        }
        float share = (bend / (area * max(most, 1e-30)) - STEP_FROM) / (STEP_FULL - STEP_FROM);
        if (whole && share > 0.0)
            edge_add(at, uvec3(floatBitsToUint(min(share, 1.0) / area), 0u, 0u));
    }
}
