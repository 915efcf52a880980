// Finest level of the pyramid that guesses depth, at half the picture's size.
#include "fill/slope.glsl"
uniform sampler2D known, normals; // push.frag
uniform vec4 view_focal;
uniform float typical;
layout(location = 0) out vec4 seeded;

void main()
{
    ivec2 at = 2 * ivec2(gl_FragCoord.xy), area = textureSize(known, 0);
    seeded = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 child = ivec2(i & 1, i >> 1), from = at + child;
        float z = from.x < area.x && from.y < area.y ? texelFetch(known, from, 0).x : 0.0;
        vec4 stored = texelFetch(normals, from, 0);
        vec3 normal = stored.a > 0.0 ? 2.0 * stored.rgb - 1.0 : vec3(0.0);
        vec3 ray = vec3((vec2(from) + 0.5 - view_focal.zw) / view_focal.xy, 1.0);
        seeded += z > 0.0 ? slope_seed(z, normal, ray, view_focal.xy, typical, 0.5 - vec2(child)) : vec4(0.0);
    }
}
