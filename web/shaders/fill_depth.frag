// Guesses background depth, negative, where there is none: what is known around, but no farther
// than the ground.
#include "fill_finer.glsl"
uniform sampler2D known, filled;
uniform vec4 view_focal;
uniform vec4 ground; // dot(xyz, ray) is its inverse depth; w: the least that counts
layout(location = 0) out float depth;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    depth = texelFetch(known, at, 0).x;
    vec4 finer = fill_finer(filled, at);
    if (depth > 0.0 || !(finer.r > 0.0))
        return;
    float inverse = dot(ground.xyz, vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0));
    depth = -1.0 / max(finer.r / finer.a, inverse > ground.w ? inverse : 0.0);
}
