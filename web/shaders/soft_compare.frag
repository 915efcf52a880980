// How far soft splats in the view differ from those in the photographs, as shaders/soft/compare.comp makes it.
uniform sampler2D blended;
uniform sampler2D source; // gather.frag
uniform float mean_level;
#include "soft/shown.glsl"
layout(location = 0) out float differs;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 photographs = texelFetch(source, at, 0);
    differs = photographs.a > 0.0 ? shown_at(blended, at) - photographs.b : 0.0;
}
