// Estimates depth in the holes of a photograph's depth map and writes it as a negative value.
// Points clearly behind the rim of a hole are occluded in the hole as well. A pixel is in a hole
// unless half of the eight directions, side by side, have no depth: sky beside a building is no
// hole.
#define BLOCK_HOLES
#include "shared/render_blocks.h"
#include "proxy/kept.glsl"

layout(local_size_x = ORL_PIXEL_GROUP_X, local_size_y = ORL_PIXEL_GROUP_Y) in;
layout(r32f, binding = 0) readonly uniform image2D depth;
layout(binding = 1) writeonly uniform image2D guessed; // the same depth, with estimates

const int DIRECTIONS = 8, STRIDE = 2;
const int REACH_SHARE = 24; // reach: the picture's longer side divided by this

void main()
{
    ivec2 to = ivec2(gl_GlobalInvocationID.xy);
    if (to.x >= kept_size.x || to.y >= kept_size.y)
        return;
    ivec2 at = drawn_texel(to, drawn_size, kept_size);
    float here = imageLoad(depth, at).r;
    if (here > 0.0) {
        imageStore(guessed, to, vec4(here));
        return;
    }
    int reach = max(drawn_size.x, drawn_size.y) / REACH_SHARE;
    float sum = 0.0, total = 0.0; // weighted inverse depth, weights
    int empty = 0, longest = 0, first = 0;
    for (int k = 0; k < DIRECTIONS; k++) {
        int turn = k & 3, back = k < 4 ? 1 : -1;
        ivec2 ahead = back * ivec2(turn == 2 ? 0 : turn == 3 ? -1 : 1, turn == 0 ? 0 : 1);
        float found = 0.0;
        int r = 0;
        while (!(found > 0.0) && r < reach) {
            r += STRIDE;
            found = imageLoad(depth, at + r * ahead).r; // 0 outside
        }
        bool met = found > 0.0;
        sum += met ? 1.0 / (found * float(r)) : 0.0;
        total += met ? 1.0 / float(r) : 0.0;
        empty = met ? 0 : empty + 1;
        longest = max(longest, empty);
        first += k == first && !met ? 1 : 0;
    }
    // A run of empty directions may continue from the last direction to the first.
    bool hole = total > 0.0 && max(longest, empty + first) < DIRECTIONS / 2;
    imageStore(guessed, to, vec4(hole ? -total / sum : 0.0));
}
