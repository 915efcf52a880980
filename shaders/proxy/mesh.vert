// A triangle mesh as a view's camera sees it. COLORS: with the colours of its vertices.
#define BLOCK_MESH
#include "shared/render_blocks.h"
#ifdef COLORS
#include "shared/srgb.glsl"
#endif

layout(location = 0) in vec3 position; // world
layout(location = 0) out vec3 in_camera;
#ifdef COLORS
layout(location = 1) in vec4 color; // sRGB
layout(location = 1) out vec3 light; // linear
#endif

void main()
{
    vec3 d = position - eye.xyz;
    vec3 p = vec3(dot(rotation[0].xyz, d), dot(rotation[1].xyz, d), dot(rotation[2].xyz, d));
    in_camera = p;
#ifdef COLORS
    light = srgb_decode(color.rgb);
#endif
    // Row 0 of the picture is row 0 of the texture. Depth runs from -1 to 1 between near and far.
    vec2 pixel = focal.xy * p.xy + focal.zw * p.z;
    float range = depth_far - depth_near;
    float depth = ((depth_far + depth_near) * p.z - 2.0 * depth_far * depth_near) / range;
    gl_Position = vec4(2.0 * pixel / vec2(view_size) - p.z, depth, p.z);
}
