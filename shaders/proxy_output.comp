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

// Pixels of the 5x5 around that have a surface within 3 % of this depth.
int support(ivec2 at, float depth)
{
    int agree = 0;
    for (int k = 0; k < 25; k++) {
        ivec2 from = clamp(at + ivec2(k % 5, k / 5) - 2, ivec2(0), level.xy - 1);
        vec4 a = imageLoad(surfel_a, from);
        agree += a.w > 0.0 && abs(a.z - depth) < 0.03 * depth ? 1 : 0;
    }
    return agree;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= level.x || at.y >= level.y)
        return;
    vec4 a = imageLoad(surfel_a, at);
    float depth = 0.0;
    vec3 normal = vec3(0.0);
    // A front without neighbours is a stray point hanging in the air.
    if (a.w > 0.0 && (level.w == 0 || support(at, a.z) >= level.w)) {
        surfel s = surfel_unpack(a, imageLoad(surfel_b, at));
        vec2 centre = vec2(at) + 0.5;
        bool inside;
        depth = surfel_depth_at(s, (centre + s.displacement - camera.zw) / camera.xy,
                                (centre - camera.zw) / camera.xy, inside);
        normal = s.normal;
    }
    imageStore(depth_out, at, vec4(depth));
    imageStore(normal_out, at, vec4(normal, 0.0));
}
