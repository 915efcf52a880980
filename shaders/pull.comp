// One pull step: a coarser level from 2x2 finer pixels. Only children inside the
// interval of the nearest one are merged, the others are occluded (Airieau 2012, 5.1).
#define BLOCK_PYRAMID
#include "include/render_blocks.h"
#include "include/octahedron.glsl"
#include "include/surfel.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(rgba32f, binding = 0) readonly uniform image2D fine_a;
layout(rgba32f, binding = 1) readonly uniform image2D fine_b;
layout(rgba32f, binding = 2) writeonly uniform image2D coarse_a;
layout(rgba32f, binding = 3) writeonly uniform image2D coarse_b;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= level.x || at.y >= level.y)
        return;
    vec4 a[4];
    float front = 1e38, front_far = 0.0;
    for (int i = 0; i < 4; i++) {
        a[i] = imageLoad(fine_a, 2 * at + ivec2(i & 1, i >> 1));
        if (a[i].w > 0.0 && a[i].x < front) {
            front = a[i].x;
            front_far = a[i].y;
        }
    }
    surfel sum = surfel(front, front_far, 0.0, 0.0, vec3(0.0), vec2(0.0));
    float count = 0.0;
    vec2 centre = level_centre(at, level.z);
    for (int i = 0; i < 4; i++) {
        if (!(a[i].w > 0.0 && a[i].x <= front_far))
            continue;
        ivec2 child = 2 * at + ivec2(i & 1, i >> 1);
        surfel s = surfel_unpack(a[i], imageLoad(fine_b, child));
        sum.far = max(sum.far, s.far);
        sum.depth += s.depth;
        sum.radius += s.radius;
        sum.normal += s.normal;
        sum.displacement += s.displacement + level_centre(child, level.z - 1) - centre;
        count += 1.0;
    }
    if (count > 0.0) {
        sum.depth /= count;
        sum.radius /= count;
        sum.displacement /= count;
        sum.normal = dot(sum.normal, sum.normal) > 1e-12 ? normalize(sum.normal)
                                                         : vec3(0.0, 0.0, -1.0);
    }
    imageStore(coarse_a, at, count > 0.0 ? surfel_pack_a(sum) : vec4(0.0));
    imageStore(coarse_b, at, count > 0.0 ? surfel_pack_b(sum) : vec4(0.0));
}
