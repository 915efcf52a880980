// Points as splats: their camera-space positions and the pixels into which they project.
#define BLOCK_SPLAT
#include "shared/render_blocks.h"

// Number of depth steps within the front layer (opt.front_layer).
const float SPLAT_LAYER_STEPS = 64.0;
// A pixel of splat_layer holds the sum of depth steps in the low bits and the count of points above
// them. It is exact for up to 8191 points in one pixel.
const uint SPLAT_LAYER_COUNT = 1u << 19;

// Subtracts the eye first, so that the difference is exact for points near the eye.
vec3 splat_camera_position(vec3 world)
{
    vec3 d = world - eye.xyz;
    return vec3(dot(rotation[0].xyz, d), dot(rotation[1].xyz, d), dot(rotation[2].xyz, d));
}

// Projects a camera-space position into the picture; false outside it.
bool splat_pixel(vec3 p, out vec2 pixel)
{
    pixel = focal.xy * p.xy / p.z + focal.zw;
    // Compares as floats, since a distant value may exceed the range of int.
    return p.z > eye.w && pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < float(view_size.x) &&
           pixel.y < float(view_size.y);
}

#ifdef SPLAT_LIST
layout(rgba32f, binding = 0) readonly uniform imageBuffer positions; // world xyz, radius
layout(r32ui, binding = 1) readonly uniform uimageBuffer items;      // from splat_cull.comp
layout(r32ui, binding = 2) readonly uniform uimageBuffer draw_arguments;

// This invocation's k-th point of the list; -1: none.
int splat_listed_point(int k)
{
    uint index = (gl_WorkGroupID.x * ORL_SPLAT_POINTS + uint(k)) *
                     (ORL_POINT_GROUP / ORL_ITEM_POINTS) +
                 gl_LocalInvocationID.x / ORL_ITEM_POINTS;
    if (index >= imageLoad(draw_arguments, 3).x)
        return -1;
    uint point = imageLoad(items, int(index)).x * ORL_ITEM_POINTS +
                 gl_LocalInvocationID.x % ORL_ITEM_POINTS;
    return int(point) < point_count ? int(point) : -1;
}

// Position of that point in the camera frame; behind the eye if there is none. Without a branch,
// the view's parameters are loaded once for all points of an invocation.
vec3 splat_listed_position(int point)
{
    vec3 p = splat_camera_position(imageLoad(positions, max(point, 0)).xyz);
    return point < 0 ? vec3(0.0, 0.0, -1.0) : p;
}
#endif
