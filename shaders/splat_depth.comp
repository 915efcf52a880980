// Nearest depth per pixel. Depth bits of positive floats order as integers.
#include "include/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(rgba32f, binding = 0) readonly uniform imageBuffer positions; // world xyz, radius
layout(r32ui, binding = 1) uniform uimage2D splat_depth;             // all ones: empty

void main()
{
    int point = int(gl_GlobalInvocationID.x);
    if (point >= size.z)
        return;
    vec3 p = splat_camera_position(imageLoad(positions, point).xyz);
    vec2 pixel;
    if (!splat_pixel(p, pixel))
        return;
    ivec2 at = ivec2(pixel);
    uint bits = floatBitsToUint(p.z);
    // What is read may be old, but then it is farther: most hidden points need no atomic.
    if (bits < imageLoad(splat_depth, at).x)
        imageAtomicMin(splat_depth, at, bits);
}
