// Finds the nearest depth of each pixel. The bits of positive floats are ordered like integers.
#define SPLAT_LIST
#include "proxy/splat.glsl"

layout(local_size_x = ORL_BLOCK_POINTS) in;
layout(r32ui, binding = 3) uniform uimage2D splat_depth; // all bits set: empty

void main()
{
    vec3 p[ORL_SPLAT_POINTS];
    for (int k = 0; k < ORL_SPLAT_POINTS; k++)
        p[k] = splat_listed_position(splat_listed_point(k));
    for (int k = 0; k < ORL_SPLAT_POINTS; k++) {
        vec2 pixel;
        if (splat_pixel(p[k], pixel))
            imageAtomicMin(splat_depth, ivec2(pixel), floatBitsToUint(p[k].z));
    }
}
