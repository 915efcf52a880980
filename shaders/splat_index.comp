// Among the points at the nearest depth the lowest index wins, so that a frame is
// the same on every run.
#include "include/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(std430, binding = 1) readonly buffer pixel_depth {
    uint depth_bits[];
};
layout(std430, binding = 2) buffer pixel_point {
    uint point_index[]; // all ones: empty
};

void main()
{
    int point = int(gl_GlobalInvocationID.x);
    if (point >= size.z)
        return;
    vec3 p = splat_camera_position(positions[point].xyz);
    vec2 pixel;
    int index = splat_pixel(p, pixel);
    if (index >= 0 && floatBitsToUint(p.z) == depth_bits[index])
        atomicMin(point_index[index], uint(size.w + point));
}
