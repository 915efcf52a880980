// The view's depth with guesses where they were picked.
uniform sampler2D view_depth, picked; // guess_pick.frag
uniform vec4 view_focal, ground;
uniform float min_inverse;
uniform int CELL;
layout(location = 0) out float depth;

float share_of(ivec2 cell)
{
    return texelFetch(picked, clamp(cell, ivec2(0), textureSize(picked, 0) - 1), 0).x;
}

#include "guess/apply.glsl"

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    float own = share_of(at / CELL);
    depth = texelFetch(view_depth, at, 0).x;
    if (depth < 0.0 && own < 1.0)
        depth = moved(at, depth);
}
