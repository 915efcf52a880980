// Which pixels of the pushed depth stay and which holes in it close, for the renderer and for the page. The including
// file defines
//   float pushed(ivec2 at): the depth there; 0: none; outside of the picture, that of the nearest pixel.

const int SUPPORT_REACH = 2;         // pixels: 5x5 around each
const float SUPPORT_AGREES = 0.03;   // of the depth: as far apart two pixels of one surface may be
const int SUPPORT_LEAST = 8;         // pixels, itself one of them: a thinner or smaller surface is an outlier
const int SUPPORT_CLOSES = 13;       // pixels: most of 5x5

// Of 2x2 pixels, of which `corner` is the upper left: a bit for each that is no outlier. depth: of the pixel, or the mean
// around it if it is a hole that closes; 0: none. The four share what is around: apart they would cost twice as much.
int support_of(ivec2 corner, out float depth[4])
{
    vec2 range[4];
    int agree[4];
    for (int i = 0; i < 4; i++) {
        depth[i] = pushed(corner + ivec2(i & 1, i >> 1));
        // Every depth agrees with a hole's.
        range[i] = depth[i] > 0.0 ? vec2(1.0 - SUPPORT_AGREES, 1.0 + SUPPORT_AGREES) * depth[i] : vec2(1e-30, 1e30);
        agree[i] = 0;
    }
    float known = 0.0, sum = 0.0, nearest = 1e30, farthest = 0.0;
    for (int y = -SUPPORT_REACH; y <= SUPPORT_REACH + 1; y++)
        for (int x = -SUPPORT_REACH; x <= SUPPORT_REACH + 1; x++) {
            float z = pushed(corner + ivec2(x, y));
            known += z > 0.0 ? 1.0 : 0.0;
            sum += z;
            nearest = min(nearest, z > 0.0 ? z : nearest);
            farthest = max(farthest, z);
            for (int i = 0; i < 4; i++) {
                ivec2 off = abs(ivec2(x, y) - ivec2(i & 1, i >> 1));
                agree[i] += max(off.x, off.y) <= SUPPORT_REACH && z >= range[i].x && z <= range[i].y ? 1 : 0;
            }
        }
    bool one_surface = farthest < (1.0 + 2.0 * SUPPORT_AGREES) * nearest;
    int kept = 0;
    for (int i = 0; i < 4; i++) {
        bool hole = !(depth[i] > 0.0), closes = hole && one_surface && agree[i] >= SUPPORT_CLOSES;
        bool keeps = !hole && agree[i] >= SUPPORT_LEAST;
        kept |= keeps ? 1 << i : 0;
        depth[i] = keeps ? depth[i] : closes ? sum / known : 0.0;
    }
    return kept;
}
