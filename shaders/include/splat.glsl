// Points as splats: where they are and which pixel they fall into.
#define BLOCK_SPLAT
#include "include/render_blocks.h"

// Resolution of the front layer's depth.
const float SPLAT_LAYER_STEPS = 64.0;
// A pixel's word of splat_layer: sum of steps below, count of points above; exact for up to
// 8191 points in one pixel.
const uint SPLAT_LAYER_COUNT = 1u << 19;

// World relative to the eye first: the difference is exact where it matters.
vec3 splat_camera_position(vec3 world)
{
    vec3 d = world - eye.xyz;
    return vec3(dot(rotation[0].xyz, d), dot(rotation[1].xyz, d), dot(rotation[2].xyz, d));
}

// Where a camera-space position falls in the picture; false outside it.
bool splat_pixel(vec3 p, out vec2 pixel)
{
    pixel = focal.xy * p.xy / p.z + focal.zw;
    // Compare as floats: a far-off value does not fit an int.
    return p.z > eye.w && pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < float(size.x) &&
           pixel.y < float(size.y);
}
