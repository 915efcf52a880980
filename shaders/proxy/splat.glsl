// Points as splats: their camera-space positions and the pixels into which they project.
#define BLOCK_SPLAT
#include "shared/render_blocks.h"
#include "proxy/point.glsl"

// Number of depth steps within the front layer (opt.front_layer).
const float SPLAT_LAYER_STEPS = 64.0;
// A pixel of splat_layer holds the sum of depth steps in the low bits and the count of points above
// them. It is exact for up to 8191 points in one pixel.
const uint SPLAT_LAYER_COUNT = 1u << 19;

// Rotates a world vector into the camera frame.
vec3 splat_camera_vector(vec3 d)
{
    return vec3(dot(rotation[0].xyz, d), dot(rotation[1].xyz, d), dot(rotation[2].xyz, d));
}

// Subtracts the eye first, so that the difference is exact for points near the eye. corner: of the
// point's block, and its step. splat_index.comp compares the depth with that of splat_depth.comp: `precise`
// makes it the same in both programs.
vec3 splat_camera_position(uvec2 code, vec4 corner)
{
    precise vec3 from_eye = corner.xyz - eye.xyz + corner.w * point_steps(code);
    precise vec3 p = vec3(rotation[0].x, rotation[1].x, rotation[2].x) * from_eye.x +
                     vec3(rotation[0].y, rotation[1].y, rotation[2].y) * from_eye.y +
                     vec3(rotation[0].z, rotation[1].z, rotation[2].z) * from_eye.z;
    return p;
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
layout(rg32ui, binding = 0) readonly uniform uimageBuffer points; // proxy/point.glsl
layout(r32ui, binding = 1) readonly uniform uimageBuffer items;      // from splat_cull.comp
layout(r32ui, binding = 2) readonly uniform uimageBuffer draw_arguments;
layout(binding = 0) uniform samplerBuffer blocks; // ORL_BLOCK_VEC4S each

// This invocation's k-th point of the list and its block; -1: none.
ivec2 splat_listed_point(int k)
{
    uint index = (gl_WorkGroupID.x * ORL_SPLAT_POINTS + uint(k)) *
                     (ORL_POINT_GROUP / ORL_ITEM_POINTS) +
                 gl_LocalInvocationID.x / ORL_ITEM_POINTS;
    uint count = imageLoad(draw_arguments, 3).x;
    uint item = imageLoad(items, int(min(index, max(count, 1u) - 1u))).x;
    int block = int(item & ((1u << ORL_ITEM_BLOCK_BITS) - 1u));
    int part = int(item >> ORL_ITEM_BLOCK_BITS);
    int point = (part * (point_count / ORL_BLOCK_POINTS) + block) * ORL_ITEM_POINTS +
                int(gl_LocalInvocationID.x) % ORL_ITEM_POINTS;
    return index < count ? ivec2(point, block) : ivec2(-1);
}

// Position of that point in the camera frame; behind the eye if there is none. Without a branch,
// the view's parameters are loaded once for all points of an invocation.
vec3 splat_listed_position(ivec2 listed)
{
    uvec2 code = imageLoad(points, max(listed.x, 0)).xy;
    vec4 corner = texelFetch(blocks, ORL_BLOCK_VEC4S * max(listed.y, 0) + 3);
    vec3 p = splat_camera_position(code, corner);
    return listed.x < 0 || !point_exists(code) ? vec3(0.0, 0.0, -1.0) : p;
}
#endif
