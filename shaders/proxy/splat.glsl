// Points as splats: their camera-space positions and the pixels into which they project.
#define BLOCK_SPLAT
#include "shared/render_blocks.h"
#include "proxy/point.glsl"

// Number of depth steps within the front layer (opt.front_layer).
const float SPLAT_LAYER_STEPS = 64.0;
// A pixel of splat_layer holds the sum of depth steps in the low bits and the count of points above
// them. It is exact for up to 8191 points in one pixel; with more, the depth stays within the front layer.
const uint SPLAT_LAYER_COUNT = 1u << 19;

// Rotates a world vector into the camera frame.
vec3 splat_camera_vector(vec3 d)
{
    return vec3(dot(rotation[0].xyz, d), dot(rotation[1].xyz, d), dot(rotation[2].xyz, d));
}

// Subtracts the eye first, so that the difference is exact for points near the eye. corner: of the
// point's block, and its step. splat_index.comp compares the depth with that of splat_depth.comp: `precise`
// makes it, and the pixel, the same in both programs.
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
    precise vec2 at = focal.xy * p.xy / p.z + focal.zw;
    pixel = at;
    // Compares as floats, since a distant value may exceed the range of int.
    return p.z > eye.w && pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < float(view_size.x) &&
           pixel.y < float(view_size.y);
}

#ifdef SPLAT_LIST
layout(rg32ui, binding = 0) readonly uniform uimageBuffer points; // proxy/point.glsl
layout(r32ui, binding = 1) readonly uniform uimageBuffer listed; // from splat_cull.comp
layout(r32ui, binding = 2) readonly uniform uimageBuffer draw_arguments;
layout(binding = 0) uniform samplerBuffer blocks; // ORL_BLOCK_VEC4S each

// This invocation's point of the group's k-th listed block; -1: none.
int splat_listed_point(int k)
{
    uint index = gl_WorkGroupID.x * ORL_SPLAT_POINTS + uint(k), count = imageLoad(draw_arguments, 3).x;
    int block = int(imageLoad(listed, int(min(index, max(count, 1u) - 1u))).x);
    return index < count ? block * ORL_BLOCK_POINTS + int(gl_LocalInvocationID.x) : -1;
}

// Position of that point in the camera frame; behind the eye if there is none. Without a branch,
// the view's parameters are loaded once for all points of an invocation.
vec3 splat_listed_position(int point)
{
    uvec2 code = imageLoad(points, max(point, 0)).xy;
    vec4 corner = texelFetch(blocks, ORL_BLOCK_VEC4S * (max(point, 0) / ORL_BLOCK_POINTS) + 2);
    vec3 p = splat_camera_position(code, corner);
    return point < 0 || !point_exists(code) ? vec3(0.0, 0.0, -1.0) : p;
}
#endif
