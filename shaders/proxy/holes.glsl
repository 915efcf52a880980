// Estimates of depth in the holes of a photograph's depth map, for the renderer and for the page. The including file
// defines
//   float known(ivec2 at): the depth there; 0: none, and outside of the map.

const int DIRECTIONS = 8, STRIDE = 2;
const int REACH_SHARE = 24; // reach: the map's longer side divided by this

// The estimate for a pixel without depth, as a negative value; 0: it is in no hole. Points clearly behind the rim of a
// hole are occluded in the hole as well. A pixel is in a hole unless half of the eight directions, side by side, have
// no depth: sky beside a building is no hole. size: of the map, pixels.
float hole_depth(ivec2 at, ivec2 size)
{
    int reach = max(size.x, size.y) / REACH_SHARE;
    float sum = 0.0, total = 0.0; // weighted inverse depth, weights
    int empty = 0, longest = 0, first = 0;
    for (int k = 0; k < DIRECTIONS; k++) {
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
    // A run of empty directions may continue from the last direction to the first.
    bool hole = total > 0.0 && max(longest, empty + first) < DIRECTIONS / 2;
    return hole ? -total / sum : 0.0;
}
