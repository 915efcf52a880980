// Guesses background depth, negative, where there is none: what continues the surfaces around, but
// no farther than the ground.
#include "fill_finer.glsl"
uniform sampler2D known, filled;
uniform vec4 view_focal;
uniform float min_inverse; // of the farthest guess
uniform vec4 ground; // dot(xyz, ray) is its inverse depth; w: the least that counts
layout(location = 0) out float depth;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    depth = texelFetch(known, at, 0).x;
    vec4 finer = fill_finer(filled, at);
    if (depth > 0.0 || !(finer.a > 0.0))
        return;
    // Surfaces that recede would continue beyond infinity.
    float inverse = max(finer.r / finer.a, min_inverse);
    float on_ground = dot(ground.xyz, vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0));
    depth = -1.0 / max(inverse, on_ground > ground.w ? on_ground : 0.0);
}
