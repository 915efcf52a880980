#include "preprocess/calibrate/sift_match.h"

#include <math.h>

enum { SIZE = ORL_SIFT_SIZE, TILE = 64, ROWS = 4 };

static const float LENGTH2 = 512.f * 512; // squared length of a descriptor

void orl_sift_widen(const uint8_t *from, size_t count, int16_t *to)
{
    for (size_t k = 0; k < count * SIZE; k++)
        to[k] = from[k];
}

// Dot products of `rows` rows of `a`, up to ROWS, with a tile of `b`. Every x86-64 processor has SSE2; most
// have AVX2, which is twice as wide. ThreadSanitizer begins after functions have been chosen.
#if defined __x86_64__ && !defined __SANITIZE_THREAD__
__attribute__((target_clones("default", "avx2")))
#endif
static void multiply(const int16_t *a, size_t rows, const int16_t *b, size_t b_count, int32_t dots[ROWS][TILE])
{
    for (size_t j = 0; j < b_count; j++) {
        for (size_t i = 0; i < rows; i++) {
            int32_t sum = 0;
            for (size_t k = 0; k < SIZE; k++)
                sum += a[i * SIZE + k] * b[j * SIZE + k];
            dots[i][j] = sum;
        }
    }
}

static inline void consider(struct orl_nearest *nearest, int32_t value, size_t index)
{
    if (value > nearest->best)
        *nearest = (struct orl_nearest){value, nearest->best, (uint32_t)index};
    else if (value > nearest->second)
        nearest->second = value;
}

void orl_sift_nearest(const int16_t *a, size_t a_count, const int16_t *b, size_t b_count,
                      struct orl_nearest *of_a, struct orl_nearest *of_b)
{
    int32_t dots[ROWS][TILE];
    for (size_t i = 0; i < a_count; i++)
        of_a[i] = (struct orl_nearest){-1, -1, 0};
    for (size_t j = 0; j < b_count; j++)
        of_b[j] = (struct orl_nearest){-1, -1, 0};
    // A tile of b stays in the first cache while all of a passes.
    for (size_t tile = 0; tile < b_count; tile += TILE) {
        size_t width = b_count - tile < TILE ? b_count - tile : TILE;
        for (size_t row = 0; row < a_count; row += ROWS) {
            size_t rows = a_count - row < ROWS ? a_count - row : ROWS;
            multiply(a + row * SIZE, rows, b + tile * SIZE, width, dots);
            for (size_t i = 0; i < rows; i++) {
                for (size_t j = 0; j < width; j++) {
                    consider(&of_a[row + i], dots[i][j], tile + j);
                    consider(&of_b[tile + j], dots[i][j], row + i);
                }
            }
        }
    }
}

static float angle(int32_t dot)
{
    return acosf(fminf((float)dot / LENGTH2, 1));
}

static bool is_distinct(const struct orl_nearest *nearest)
{
    // A lone feature has nothing to be told apart from.
    return nearest->second >= 0 && angle(nearest->best) <= 0.7f &&
           angle(nearest->best) < 0.8f * angle(nearest->second);
}

bool orl_sift_is_match(const struct orl_nearest *of_a, const struct orl_nearest *of_b, size_t i)
{
    if (!is_distinct(&of_a[i]))
        return false;
    const struct orl_nearest *back = &of_b[of_a[i].index];
    return back->index == i && is_distinct(back);
}
