// Lists the pixels at depth discontinuities, each with the weight of its neighbours; in a photograph such
// a pixel shows both sides. antialias.comp then averages the listed pixels. One invocation handles 2x2
// pixels.
#include "shared/image.glsl"
#include "edges/edge.glsl"
#include "edges/edge_list.glsl"

layout(r32f, binding = 0) readonly uniform image2D depth; // < 0: estimated background depth

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
    const int along[4] = int[4](1, 3, 4, 5); // index offsets to the next pixel in four directions
    for (int k = 0; k < 4; k++) {
        ivec2 at = corner + ivec2(k & 1, k >> 1);
        bool whole = all(greaterThan(at, ivec2(0))) && all(lessThan(at, image_size - 1));
        int own = 5 + (k & 1) + 4 * (k >> 1);
        vec4 before, after;
        for (int n = 0; n < 4; n++) {
            before[n] = inverse[own - along[n]];
            after[n] = inverse[own + along[n]];
        }
        float aside = edge_aside(inverse[own], before, after, footprint);
        if (whole && aside > 0.0)
            edge_add(at, uvec3(floatBitsToUint(aside), 0u, 0u));
    }
}
