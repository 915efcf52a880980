// A photograph's depth from its packed file, and guesses, negative, in its holes.
uniform sampler2D packed_depth; // high byte red, low byte green
uniform float steps_per_fold, nearest; // nearest: what the nearest depth becomes
layout(location = 0) out float depth;

float known(ivec2 at)
{
    ivec2 area = textureSize(packed_depth, 0);
    if (at.x < 0 || at.y < 0 || at.x >= area.x || at.y >= area.y)
        return 0.0;
    vec2 bytes = texelFetch(packed_depth, at, 0).rg * 255.0;
    float value = round(bytes.r) * 256.0 + round(bytes.g);
    return value > 0.0 ? nearest * exp((value - 1.0) / steps_per_fold) : 0.0;
}

#include "proxy/holes.glsl"

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    depth = known(at);
    if (!(depth > 0.0))
        depth = hole_depth(at, textureSize(packed_depth, 0));
}
