// Nearest depth per pixel. Depth bits of positive floats order as integers.
#include "include/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(std430, binding = 1) buffer pixel_depth {
    uint depth_bits[]; // all ones: empty
};

void main()
{
    int point = int(gl_GlobalInvocationID.x);
    if (point >= size.z)
        return;
    vec3 p = splat_camera_position(positions[point].xyz);
    vec2 pixel;
    int index = splat_pixel(p, pixel);
    if (index >= 0)
        atomicMin(depth_bits[index], floatBitsToUint(p.z));
}
