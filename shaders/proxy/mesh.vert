// A triangle mesh as a view's camera sees it.
#define BLOCK_MESH
#include "shared/render_blocks.h"

layout(location = 0) in vec3 position; // world
layout(location = 0) out vec3 in_camera;

void main()
{
    vec3 d = position - eye.xyz;
    vec3 p = vec3(dot(rotation[0].xyz, d), dot(rotation[1].xyz, d), dot(rotation[2].xyz, d));
    in_camera = p;
    // Row 0 of the picture is row 0 of the texture. Depth runs from -1 to 1 between near and far.
    vec2 pixel = focal.xy * p.xy + focal.zw * p.z;
    float range = depth_far - depth_near;
    float depth = ((depth_far + depth_near) * p.z - 2.0 * depth_far * depth_near) / range;
    gl_Position = vec4(2.0 * pixel / vec2(view_size) - p.z, depth, p.z);
}
