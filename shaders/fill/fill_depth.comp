// Writes the estimated background depth, as a negative value, where the proxy has none. It continues
// the surfaces around the pixel, but no farther than the ground (the floor of Li's room box, its
// only reliable side).
#define FAR
#include "fill/apply.glsl"
#include "shared/constants.h"

layout(r32f, binding = 1) uniform image2D depth;

bool fill_wants(ivec2 at)
{
    return !(imageLoad(depth, at).r > 0.0);
}

void fill_pixel(ivec2 at, vec4 value)
{
    vec3 ray = vec3((vec2(at) + 0.5 - focal.zw) / focal.xy, 1.0);
    if (value.a > 0.0)
        imageStore(depth, at, vec4(slope_guess(value, 1.0 / (ORL_GUESS_FARTHEST * depth_scale), ground, ray)));
}
