// Lists the pixels that can be specks. One invocation handles 2x2 pixels.
#include "shared/image.glsl"
#include "edges/edge_list.glsl"
#include "edges/speck.glsl"

layout(rg8, binding = 0) readonly uniform image2D painted; // gather/tiled.comp

void main()
{
    ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (corner.x >= image_size.x || corner.y >= image_size.y)
        return;
    float light[16]; // of the 4x4 pixels around; 0: unpainted, or outside
    for (int k = 0; k < 16; k++)
        light[k] = imageLoad(painted, corner + ivec2(k & 3, k >> 2) - 1).g;
    for (int k = 0; k < 4; k++) {
        int own = 5 + (k & 1) + 4 * (k >> 1);
        float around[9];
        for (int n = 0; n < 9; n++) {
            float other = light[own - 5 + n % 3 + 4 * (n / 3)];
            around[n] = other > 0.0 ? other : light[own];
        }
        if (light[own] > 0.0 && speck_suspect(around))
            edge_add(corner + ivec2(k & 1, k >> 1), uvec3(0u));
    }
}
