// Reads the pyramid of hole filling, whose finest level has half the picture's size. The including
// file declares the level's image, `filled`.
// FAR: the values are those of fill/slope.glsl.
#ifdef FAR
#include "fill/slope.glsl"
#else
#define slope_moved(value, by) value
#define slope_soft(value) value
#define slope_hard(value) value
#endif

// Bilinear values for the 2x2 finer pixels of a pixel, as in the push of Gortler 1996. All four
// are computed at once, since they share their reads.
void fill_finer(ivec2 parent, out vec4 finer[4])
{
    ivec2 last = imageSize(filled) - 1;
    vec4 upper[3], lower[3]; // one entry for each of three columns
    for (int x = 0; x < 3; x++) {
        vec4 column[3];
        for (int y = 0; y < 3; y++) {
            ivec2 at = clamp(parent + ivec2(x, y) - 1, ivec2(0), last);
            column[y] = slope_moved(slope_soft(imageLoad(filled, at)), vec2(parent - at));
        }
        upper[x] = 0.75 * column[1] + 0.25 * column[0];
        lower[x] = 0.75 * column[1] + 0.25 * column[2];
    }
    finer = vec4[4](0.75 * upper[1] + 0.25 * upper[0], 0.75 * upper[1] + 0.25 * upper[2],
                    0.75 * lower[1] + 0.25 * lower[0], 0.75 * lower[1] + 0.25 * lower[2]);
    for (int k = 0; k < 4; k++)
        finer[k] = slope_hard(slope_moved(finer[k], vec2(k & 1, k >> 1) * 0.5 - 0.25));
}
