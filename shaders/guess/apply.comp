// Replaces the estimated background depth in open cells by what was picked, no farther than the
// ground. Between cells of about the same depth it is interpolated.
#define BLOCK_GATHER
#include "shared/render_blocks.h"
#include "guess/planes.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) uniform image2D view_depth;        // < 0: estimated background depth
layout(r32f, binding = 2) readonly uniform image2D picked;   // inverse depth; 0: a closed cell

const float SAME = 1.5; // difference of planes

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    float own = imageLoad(picked, at / GUESS_CELL).r;
    if (!(imageLoad(view_depth, at).r < 0.0 && own > 0.0))
        return;
    vec2 place = (vec2(at) + 0.5) / float(GUESS_CELL) - 0.5, part = fract(place);
    vec2 sum = vec2(own, 1.0) * 1e-6;
    for (int k = 0; k < 4; k++) {
        float other = imageLoad(picked, ivec2(floor(place)) + ivec2(k & 1, k >> 1)).r; // 0 outside
        float weight = ((k & 1) == 0 ? 1.0 - part.x : part.x) * (k < 2 ? 1.0 - part.y : part.y);
        bool same = other > 0.0 && abs(other - own) < SAME * plane_step;
        sum += same ? vec2(other, 1.0) * weight : vec2(0.0);
    }
    float on_ground = dot(ground.xyz, vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0));
    float inverse = max(sum.x / sum.y, on_ground > ground.w ? on_ground : 0.0);
    imageStore(view_depth, at, vec4(-1.0 / inverse));
}
