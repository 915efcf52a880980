// Points as splats: where they are and which pixel they fall into.
#define BLOCK_SPLAT
#include "shared/render_blocks.h"

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
    return p.z > eye.w && pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < float(view_size.x) &&
           pixel.y < float(view_size.y);
}

#ifdef SPLAT_LIST
layout(rgba32f, binding = 0) readonly uniform imageBuffer positions; // world xyz, radius
layout(r32ui, binding = 1) readonly uniform uimageBuffer items;      // splat_cull.comp
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

// Its position in the camera's frame; behind the eye for none. No branch, so that the
// view's parameters are loaded once for all points of an invocation.
vec3 splat_listed_position(int point)
{
    vec3 p = splat_camera_position(imageLoad(positions, max(point, 0)).xyz);
    return point < 0 ? vec3(0.0, 0.0, -1.0) : p;
}
#endif
