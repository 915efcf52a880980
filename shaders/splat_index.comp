// Among the points at the nearest depth the lowest index wins, so that a frame is
// the same on every run. The points of the same layer are summed for their mean depth,
// in whole numbers for the same reason: the nearest of many noisy points is too near.
#include "include/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(std430, binding = 1) readonly buffer pixel_depth {
    uint depth_bits[];
};
layout(std430, binding = 2) buffer pixel_point {
    uint point_index[]; // all ones: empty
};
layout(std430, binding = 3) buffer pixel_layer {
    uvec2 layer[]; // points of the front layer, sum of their SPLAT_LAYER_STEPS behind it
};

void main()
{
    int point = int(gl_GlobalInvocationID.x);
    if (point >= size.z)
        return;
    vec3 p = splat_camera_position(positions[point].xyz);
    vec2 pixel;
    int index = splat_pixel(p, pixel);
    if (index < 0)
        return;
    uint front_bits = depth_bits[index];
    if (floatBitsToUint(p.z) == front_bits)
        atomicMin(point_index[index], uint(size.w + point));
    float front = uintBitsToFloat(front_bits);
    float behind = (p.z - front) / (front * options.y);
    if (options.y > 0.0 && behind <= 1.0) {
        atomicAdd(layer[index].x, 1u);
        atomicAdd(layer[index].y, uint(behind * SPLAT_LAYER_STEPS));
    }
}
