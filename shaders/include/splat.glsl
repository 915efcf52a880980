// Projection of points, shared by the splat passes.
#define BLOCK_SPLAT
#include "include/render_blocks.h"

// Resolution of the front layer's depth; 2^32 / this many points fit one pixel's sum.
const float SPLAT_LAYER_STEPS = 1024.0;

layout(std430, binding = 0) readonly buffer point_positions {
    vec4 positions[]; // world xyz, radius
};

// World relative to the eye first: the difference is exact where it matters.
vec3 splat_camera_position(vec3 world)
{
    vec3 d = world - eye.xyz;
    return vec3(dot(rotation[0].xyz, d), dot(rotation[1].xyz, d), dot(rotation[2].xyz, d));
}

// Pixel of a camera-space position, and its linear index; -1 outside the picture.
int splat_pixel(vec3 p, out vec2 pixel)
{
    pixel = vec2(-1.0);
    if (!(p.z > eye.w))
        return -1;
    pixel = focal.xy * p.xy / p.z + focal.zw;
    // Compare as floats: a far-off value does not fit an int.
    if (!(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < float(size.x) && pixel.y < float(size.y)))
        return -1;
    return int(pixel.y) * size.x + int(pixel.x);
}
