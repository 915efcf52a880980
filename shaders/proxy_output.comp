// Depth and normal at pixel centres, from level 0 of the pyramid.
#define BLOCK_PYRAMID
#include "include/render_blocks.h"
#include "include/octahedron.glsl"
#include "include/surfel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D surfel_a;
layout(rgba32f, binding = 1) readonly uniform image2D surfel_b;
layout(r32f, binding = 2) writeonly uniform image2D depth_out;
layout(rgba16f, binding = 3) writeonly uniform image2D normal_out; // 0: none

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= level.x || at.y >= level.y)
        return;
    vec4 a = imageLoad(surfel_a, at);
    float depth = 0.0;
    vec3 normal = vec3(0.0);
    if (a.w > 0.0) {
        surfel s = surfel_unpack(a, imageLoad(surfel_b, at));
        vec2 centre = vec2(at) + 0.5;
        bool inside;
        depth = surfel_depth_at(s, centre + s.displacement, centre, camera, inside);
        normal = s.normal;
    }
    imageStore(depth_out, at, vec4(depth));
    imageStore(normal_out, at, vec4(normal, 0.0));
}
