// Fills pixels that know nothing from the coarser level.
#include "fill_finer.glsl"
uniform sampler2D fine, coarse;
layout(location = 0) out vec4 filled;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 own = texelFetch(fine, at, 0);
    filled = own.a > 0.0 ? own : fill_finer(coarse, at);
}
