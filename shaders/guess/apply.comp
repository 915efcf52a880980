// Moves the estimated background depth of open cells to where it was picked, no farther than the
// ground. Between cells that were moved by about as much it is interpolated.
#define BLOCK_GATHER
#include "shared/render_blocks.h"
#include "guess/planes.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) uniform image2D view_depth;      // < 0: estimated background depth
layout(r32f, binding = 2) readonly uniform image2D picked; // share of inverse depth; 1: unmoved

const float SAME = 0.2; // difference of shares

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= view_size.x || at.y >= view_size.y)
        return;
    float own = imageLoad(picked, at / CELL).r, depth = imageLoad(view_depth, at).r;
    if (!(depth < 0.0 && own < 1.0))
        return;
    vec2 place = (vec2(at) + 0.5) / float(CELL) - 0.5, part = fract(place);
    vec2 sum = vec2(own, 1.0) * 1e-6;
    for (int k = 0; k < 4; k++) {
        ivec2 cell = clamp(ivec2(floor(place)) + ivec2(k & 1, k >> 1), ivec2(0),
                           cells_across_down() - 1);
        float other = imageLoad(picked, cell).r;
        float weight = ((k & 1) == 0 ? 1.0 - part.x : part.x) * (k < 2 ? 1.0 - part.y : part.y);
        sum += abs(other - own) < SAME ? vec2(other, 1.0) * weight : vec2(0.0);
    }
    float on_ground = dot(ground.xyz, vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0));
    float inverse = max(sum.x / sum.y / -depth, min_inverse);
    imageStore(view_depth, at, vec4(-1.0 / max(inverse, on_ground > ground.w ? on_ground : 0.0)));
}
