// Reads the pyramid of hole filling, whose finest level has half the picture's size. The including
// file defines FILL_LEVEL as the name of the level's image.
// FAR: the values are inverse depth in x and its slope in yz, per pixel of the level, each times the
// weight in a, as SEED_DEPTH of fill_seed.comp makes them.
#ifdef FAR
// The same value, moved to where another pixel of the level is.
vec4 fill_moved(vec4 value, vec2 by)
{
    value.x += dot(value.yz, by);
    return value;
}

// Weights that differ by many powers of ten would let the farther value win as far as its bilinear
// weight reaches, and there end in a line. So values are interpolated with the fourth roots of their
// weights. The weight itself is interpolated likewise, and keeps its scale.
vec4 fill_soft(vec4 value)
{
    return value.a > 0.0 ? value * (sqrt(sqrt(value.a)) / value.a) : vec4(0.0);
}

vec4 fill_hard(vec4 value)
{
    value.yz *= 0.5; // pixels of the finer level are half as large
    return value * (value.a * value.a * value.a);
}
#else
vec4 fill_moved(vec4 value, vec2 by)
{
    return value;
}

vec4 fill_soft(vec4 value)
{
    return value;
}

vec4 fill_hard(vec4 value)
{
    return value;
}
#endif

// Bilinear values for the 2x2 finer pixels of a pixel, as in the push of Gortler 1996. All four
// are computed at once, since they share their reads.
void fill_finer(ivec2 parent, out vec4 finer[4])
{
    ivec2 last = imageSize(FILL_LEVEL) - 1;
    vec4 upper[3], lower[3]; // one entry for each of three columns
    for (int x = 0; x < 3; x++) {
        vec4 column[3];
        for (int y = 0; y < 3; y++) {
            ivec2 at = clamp(parent + ivec2(x, y) - 1, ivec2(0), last);
            column[y] = fill_moved(fill_soft(imageLoad(FILL_LEVEL, at)), vec2(parent - at));
        }
        upper[x] = 0.75 * column[1] + 0.25 * column[0];
        lower[x] = 0.75 * column[1] + 0.25 * column[2];
    }
    finer = vec4[4](0.75 * upper[1] + 0.25 * upper[0], 0.75 * upper[1] + 0.25 * upper[2],
                    0.75 * lower[1] + 0.25 * lower[0], 0.75 * lower[1] + 0.25 * lower[2]);
    for (int k = 0; k < 4; k++)
        finer[k] = fill_hard(fill_moved(finer[k], vec2(k & 1, k >> 1) * 0.5 - 0.25));
}
