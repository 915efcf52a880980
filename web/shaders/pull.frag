// A coarser level of the pyramid from 2x2 finer pixels.
// FINEST: from level 0.
#include "level0.glsl"

#ifndef FINEST
uniform sampler2D fine_a;
uniform highp usampler2D fine_b;
#endif
uniform int level; // that is written
layout(location = 0) out vec4 coarse_a;
layout(location = 1) out uvec2 coarse_b;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    surfel child[4];
    for (int i = 0; i < 4; i++) {
        ivec2 from = 2 * at + ivec2(i & 1, i >> 1);
#ifdef FINEST
        child[i] = level0(from);
#else
        child[i] = NO_SURFEL;
        if (within(from, textureSize(fine_a, 0)))
            child[i] = surfel_unpack(texelFetch(fine_a, from, 0),
                                     uvec4(texelFetch(fine_b, from, 0).xy, 0u, 0u));
#endif
    }
    surfel merged = surfel_merge(child, level - 1);
    coarse_a = surfel_pack_a(merged);
    coarse_b = surfel_pack_b(merged).xy;
}
