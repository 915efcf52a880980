// The photographs that can paint a tile of the screen best: eight bytes, best first, 255: none.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"

uniform sampler2D view_depth; // < 0: guessed
uniform int photos;
layout(location = 0) out uvec2 chosen;

float depth_at(ivec2 at)
{
    return texelFetch(view_depth, at, 0).x;
}

#include "gather/candidates.glsl"

void main()
{
    int index[ORL_CANDIDATES];
    list_candidates(ivec2(gl_FragCoord.xy), TILE, textureSize(view_depth, 0), photos, index);
    chosen = uvec2((index[0] & 255) | (index[1] & 255) << 8 | (index[2] & 255) << 16 | index[3] << 24, index[4] & 255);
}
