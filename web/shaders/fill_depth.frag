// Guesses background depth, negative, where there is none.
#include "fill_finer.glsl"
uniform sampler2D known, filled;
uniform vec4 view_focal;
uniform float min_inverse; // of the farthest guess
uniform vec4 ground; // as fill/slope.glsl has it
layout(location = 0) out float depth;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    depth = texelFetch(known, at, 0).x;
    vec4 finer = fill_finer(filled, at);
    if (depth > 0.0 || !(finer.a > 0.0))
        return;
    vec3 ray = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0);
    depth = slope_guess(finer, min_inverse, ground, ray);
}
