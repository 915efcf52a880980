// Among the points at the nearest depth the lowest index wins, so that a frame is
// the same on every run. The points of the same layer are summed for their mean depth,
// in whole numbers for the same reason: the nearest of many noisy points is too near.
#include "include/splat.glsl"

layout(local_size_x = ORL_POINT_GROUP) in;
layout(rgba32f, binding = 0) readonly uniform imageBuffer positions;
layout(r32ui, binding = 1) readonly uniform uimage2D splat_depth;
layout(r32ui, binding = 2) uniform uimage2D splat_index; // all ones: empty
layout(r32ui, binding = 3) uniform uimage2D splat_layer;

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
    uint front_bits = imageLoad(splat_depth, at).x;
    if (floatBitsToUint(p.z) == front_bits)
        imageAtomicMin(splat_index, at, uint(size.w + point));
    float front = uintBitsToFloat(front_bits);
    float behind = p.z - front, thickness = front * options.y;
    if (behind < thickness) {
        uint steps = uint(behind / thickness * SPLAT_LAYER_STEPS);
        imageAtomicAdd(splat_layer, at, SPLAT_LAYER_COUNT + steps);
    }
}
