// The frame as soft splats correct it, as shaders/soft/mix.comp does.
uniform sampler2D composed;
uniform sampler2D blended;
uniform sampler2D differs; // soft_compare.frag
uniform float mean_level, correct_share, mix_share;
#include "soft/coarse.glsl"
#include "soft/mixed.glsl"
layout(location = 0) out vec4 corrected;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    float more = correct_share * (texelFetch(differs, at, 0).r - coarse_at(differs, at).r);
    corrected = soft_mixed(texelFetch(composed, at, 0), texelFetch(blended, at, 0), more, mix_share);
}
