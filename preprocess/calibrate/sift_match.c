#include "preprocess/calibrate/sift_match.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"

enum { SIZE = ORL_SIFT_SIZE, TILE = 64, ROWS = 4 };

static const float LENGTH2 = 512.f * 512; // squared length of a descriptor

// The nearest of a feature among those of another photograph: dot products with the nearest two, -1
// where there is none, and the index of the nearest.
struct nearest {
    int32_t best, second;
    uint32_t index;
};

// `from` as 16-bit numbers, which multiply and add in pairs in one instruction (pmaddwd).
static void widen(const uint8_t *from, size_t count, int16_t *to)
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

static inline void consider(struct nearest *nearest, int32_t value, size_t index)
{
    if (value > nearest->best)
        *nearest = (struct nearest){value, nearest->best, (uint32_t)index};
    else if (value > nearest->second)
        nearest->second = value;
}

// Fills of_a for each of `a`, and of_b for each of `b`, both widened.
static void find_nearest(const int16_t *a, size_t a_count, const int16_t *b, size_t b_count,
                         struct nearest *of_a, struct nearest *of_b)
{
    int32_t dots[ROWS][TILE];
    for (size_t i = 0; i < a_count; i++)
        of_a[i] = (struct nearest){-1, -1, 0};
    for (size_t j = 0; j < b_count; j++)
        of_b[j] = (struct nearest){-1, -1, 0};
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

static bool is_distinct(const struct nearest *nearest)
{
    // A lone feature has nothing to be told apart from.
    return nearest->second >= 0 && angle(nearest->best) <= 0.7f &&
           angle(nearest->best) < 0.8f * angle(nearest->second);
}

static bool is_match(const struct nearest *of_a, const struct nearest *of_b, size_t i)
{
    if (!is_distinct(&of_a[i]))
        return false;
    const struct nearest *back = &of_b[of_a[i].index];
    return back->index == i && is_distinct(back);
}

enum orl_result orl_sift_match(const struct orl_features *a, const struct orl_features *b, size_t limit,
                               struct orl_sift_matches *matches)
{
    size_t a_count = a->count < limit ? a->count : limit, b_count = b->count < limit ? b->count : limit;
    int16_t *wide = orl_array(NULL, a_count + b_count, SIZE * sizeof *wide);
    struct nearest *nearest = orl_array(NULL, a_count + b_count, sizeof *nearest);
    *matches = (struct orl_sift_matches){.items = orl_array(NULL, a_count, sizeof *matches->items)};
    bool ok = wide && nearest && matches->items;
    if (ok) {
        int16_t *wide_b = wide + a_count * SIZE;
        struct nearest *of_b = nearest + a_count;
        widen(a->descriptors, a_count, wide);
        widen(b->descriptors, b_count, wide_b);
        find_nearest(wide, a_count, wide_b, b_count, nearest, of_b);
        for (size_t i = 0; i < a_count; i++) {
            if (!is_match(nearest, of_b, i))
                continue;
            matches->items[matches->count][0] = (uint32_t)i;
            matches->items[matches->count++][1] = nearest[i].index;
        }
    }
    free(wide);
    free(nearest);
    return ok ? ORL_OK : ORL_ERR_MEMORY;
}
