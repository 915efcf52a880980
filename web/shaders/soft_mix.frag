// The finished frame, antialiased, as soft splats correct it, as shaders/soft/mix.comp does.
#include "antialias.glsl"
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
    vec4 own = vec4(antialiased(at), texelFetch(composed, at, 0).a);
    corrected = soft_mixed(own, texelFetch(blended, at, 0), more, mix_share);
}
