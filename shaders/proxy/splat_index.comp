// Among the points at the nearest depth of a pixel the lowest index wins, so that a frame is the
// same on every run. Points of the same front layer are summed for their mean depth, since the
// nearest of many noisy points is too near. The sums are integers, for the same reproducibility.
#define SPLAT_LIST
#include "proxy/splat.glsl"

layout(local_size_x = ORL_BLOCK_POINTS) in;
layout(r32ui, binding = 3) readonly uniform uimage2D splat_depth;
layout(r32ui, binding = 4) uniform uimage2D splat_index; // all bits set: empty
layout(r32ui, binding = 5) uniform uimage2D splat_layer;

void main()
{
    int point[ORL_SPLAT_POINTS];
    vec3 p[ORL_SPLAT_POINTS];
    for (int k = 0; k < ORL_SPLAT_POINTS; k++) {
        point[k] = splat_listed_point(k);
        p[k] = splat_listed_position(point[k]);
    }
    for (int k = 0; k < ORL_SPLAT_POINTS; k++) {
        vec2 pixel;
        bool drawn = splat_pixel(p[k], pixel);
        ivec2 at = drawn ? ivec2(pixel) : ivec2(0);
        uint front_bits = imageLoad(splat_depth, at).x;
        float front = uintBitsToFloat(front_bits);
        float behind = p[k].z - front, thickness = front * front_layer;
        if (drawn && floatBitsToUint(p[k].z) == front_bits)
            imageAtomicMin(splat_index, at, uint(first_point + point[k]));
        if (drawn && behind < thickness) {
            uint steps = uint(behind / thickness * SPLAT_LAYER_STEPS);
            imageAtomicAdd(splat_layer, at, SPLAT_LAYER_COUNT + steps);
        }
    }
}
