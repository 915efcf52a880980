// A photograph's depth from its packed file, relative to its nearest; and guesses, negative, in its
// holes, as shaders/proxy/photo_holes.comp makes them.
uniform sampler2D packed_depth; // high byte red, low byte green
uniform float steps_per_fold;
layout(location = 0) out float depth;

const int STRIDE = 2, REACH_SHARE = 24; // of the picture's longer side

float known(ivec2 at)
{
    ivec2 area = textureSize(packed_depth, 0);
    if (at.x < 0 || at.y < 0 || at.x >= area.x || at.y >= area.y)
        return 0.0;
    vec2 bytes = texelFetch(packed_depth, at, 0).rg * 255.0;
    float value = round(bytes.r) * 256.0 + round(bytes.g);
    return value > 0.0 ? exp((value - 1.0) / steps_per_fold) : 0.0;
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), area = textureSize(packed_depth, 0);
    depth = known(at);
    if (depth > 0.0)
        return;
    int reach = max(area.x, area.y) / REACH_SHARE;
    float sum = 0.0, total = 0.0; // of inverse depth
    int empty = 0, longest = 0, first = 0;
    for (int k = 0; k < 8; k++) {
        int turn = k & 3, back = k < 4 ? 1 : -1;
        ivec2 ahead = back * ivec2(turn == 2 ? 0 : turn == 3 ? -1 : 1, turn == 0 ? 0 : 1);
        float found = 0.0;
        int r = 0;
        while (!(found > 0.0) && r < reach) {
            r += STRIDE;
            found = known(at + r * ahead);
        }
        bool met = found > 0.0;
        sum += met ? 1.0 / (found * float(r)) : 0.0;
        total += met ? 1.0 / float(r) : 0.0;
        empty = met ? 0 : empty + 1;
        longest = max(longest, empty);
        first += k == first && !met ? 1 : 0;
    }
    bool hole = total > 0.0 && max(longest, empty + first) < 4;
    depth = hole ? -total / sum : 0.0;
}
