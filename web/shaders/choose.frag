// The photographs that can paint a tile of the screen best, as shaders/gather/choose.comp lists
// them: eight bytes, best first, 255: none.
#include "gather/penalty.glsl"
#include "gather/hidden.glsl"

const int ACROSS = 3;
#include "gather/candidates.glsl"

uniform sampler2D view_depth; // < 0: guessed
uniform int photos;
layout(location = 0) out uvec2 chosen;

void main()
{
    ivec2 tile = ivec2(gl_FragCoord.xy), area = textureSize(view_depth, 0);
    vec3 points[9];
    float guess[9];
    for (int i = 0; i < 9; i++) {
        ivec2 at = tile * TILE + (2 * ivec2(i % ACROSS, i / ACROSS) + 1) * TILE / (2 * ACROSS);
        at = min(at, area - 1);
        float depth = texelFetch(view_depth, at, 0).x;
        points[i] = vec3((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0) * abs(depth);
        guess[i] = depth < 0.0 ? 1.0 : 0.0;
    }
    float best[ORL_CANDIDATES];
    int index[ORL_CANDIDATES];
    for (int c = 0; c < ORL_CANDIDATES; c++) {
        best[c] = NOT_SEEN;
        index[c] = 255;
    }
    for (int i = 0; i < photos; i++) {
        float least = NOT_SEEN, seen = 0.0;
        photo source = photo_at(i);
        for (int s = 0; s < 9; s++)
            candidate_sample(source, points[s], guess[s], least, seen);
        candidate_insert(candidate_penalty(least, seen), i, best, index);
    }
    chosen = uvec2(index[0] | index[1] << 8 | index[2] << 16 | index[3] << 24,
                   index[4]);
}
