// Drops stray points and closes small holes, as shaders/proxy/support.comp does.
#include "proxy/support.glsl"
uniform sampler2D depth_in, normal_in;
uniform float min_support;
layout(location = 0) out float depth_out;
layout(location = 1) out vec4 normal_out;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depth_in, 0) - 1, corner = at / 2 * 2;
    float depth = texelFetch(depth_in, at, 0).x, agree = 0.0;
    vec2 range = support_range(depth);
    depths_around around = no_depths();
    for (int y = -2; y <= 3; y++)
        for (int x = -2; x <= 3; x++) {
            ivec2 from = corner + ivec2(x, y), off = abs(from - at);
            float z = texelFetch(depth_in, clamp(from, ivec2(0), last), 0).x;
            add_depth(around, z);
            agree += max(off.x, off.y) <= 2 && z >= range.x && z <= range.y ? 1.0 : 0.0;
        }
    bool keep = support_keeps(depth, agree, min_support);
    depth_out = supported_depth(depth, keep, agree, around);
    normal_out = keep ? texelFetch(normal_in, at, 0) : vec4(0.0);
}
