// Drops outliers from the pushed depth and closes small holes, as shaders/proxy/support.comp does.
uniform sampler2D pushed_depth, pushed_normal;
layout(location = 0) out float depth_out;
layout(location = 1) out vec4 normal_out;

float pushed(ivec2 at)
{
    return texelFetch(pushed_depth, clamp(at, ivec2(0), textureSize(pushed_depth, 0) - 1), 0).x;
}

#include "proxy/support.glsl"

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), side = at & 1;
    float depth[4];
    int own = side.x + 2 * side.y, kept = support_of(at - side, depth);
    depth_out = depth[own];
    normal_out = (kept >> own & 1) == 1 ? texelFetch(pushed_normal, at, 0) : vec4(0.0);
}
