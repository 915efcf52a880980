// Blocks of points: their order along a Morton curve, and what each block says of its points.
#include "scene/point_blocks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"

enum {
    BLOCK = ORL_BLOCK_POINTS,
    SORT_BITS = 11, // bits per radix pass
    SORT_RANGE = 1 << SORT_BITS,
    BOUNDS_SAMPLES = 4096,
    SPLITS = 16, // one in so many blocks may be split for precision
};

struct key {
    uint64_t code;
    uint32_t point;
};

// --- order ---

enum orl_result orl_point_cube_find(const struct orl_log *log, const struct orl_points *points,
                                    struct point_cube *cube)
{
    size_t count = points->count < BOUNDS_SAMPLES ? points->count : BOUNDS_SAMPLES;
    float *values = orl_array(log, count + 1, sizeof *values);
    ORL_TRY_MEMORY(values);
    cube->side = 1e-30;
    for (int k = 0; k < 3; k++) {
        size_t finite = 0;
        for (size_t i = 0; i < count; i++) {
            float v = points->position[i * (points->count / count)][k];
            if (isfinite(v))
                values[finite++] = v;
        }
        if (finite == 0)
            values[finite++] = 0;
        qsort(values, finite, sizeof *values, orl_order_floats);
        double a = values[finite / 64], b = values[finite - 1 - finite / 64];
        cube->low[k] = 0.5 * (a + b);
        cube->side = fmax(cube->side, 2 * (b - a) + 1e-6 * fabs(a + b));
    }
    // The cube is off-centre: its middle plane would split a flat cloud into two layers.
    for (int k = 0; k < 3; k++)
        cube->low[k] -= 0.437 * cube->side;
    free(values);
    return ORL_OK;
}

// Spreads the low 21 bits of x to every third bit of the result.
static uint64_t spread_bits(uint64_t x)
{
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

uint64_t orl_point_cube_morton(const struct point_cube *cube, const float p[3])
{
    uint64_t code = 0;
    for (int k = 0; k < 3; k++) {
        double cell = ((double)p[k] - cube->low[k]) / cube->side * 0x1p21;
        cell = fmin(fmax(cell, 0), 0x1p21 - 1);
        code |= spread_bits((uint64_t)cell) << k;
    }
    return code;
}

// Radix sort from the least significant digit: stable, thus the same order on every machine.
static void sort_keys(struct key **keys, struct key **spare, size_t count)
{
    for (int shift = 0; shift < 63; shift += SORT_BITS) {
        size_t starts[SORT_RANGE] = {0}, sum = 0;
        for (size_t i = 0; i < count; i++)
            starts[(*keys)[i].code >> shift & (SORT_RANGE - 1)]++;
        for (size_t d = 0; d < SORT_RANGE; d++) {
            size_t here = starts[d];
            starts[d] = sum;
            sum += here;
        }
        for (size_t i = 0; i < count; i++)
            (*spare)[starts[(*keys)[i].code >> shift & (SORT_RANGE - 1)]++] = (*keys)[i];
        struct key *swap = *keys;
        *keys = *spare;
        *spare = swap;
    }
}

// The finite points along the Morton curve. The caller frees *curve.
static enum orl_result sort_points(const struct orl_log *log, const struct orl_points *points,
                                   const struct point_cube *cube, uint32_t **curve, size_t *count)
{
    struct key *keys = orl_array(log, points->count, sizeof *keys);
    struct key *spare = orl_array(log, points->count, sizeof *spare);
    *curve = orl_array(log, points->count, sizeof **curve);
    *count = 0;
    enum orl_result result = keys && spare && *curve ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        for (size_t i = 0; i < points->count; i++) {
            const float *p = points->position[i];
            if (isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]))
                keys[(*count)++] = (struct key){orl_point_cube_morton(cube, p), (uint32_t)i};
        }
        sort_keys(&keys, &spare, *count);
        for (size_t i = 0; i < *count; i++)
            (*curve)[i] = keys[i].point;
    } else {
        free(*curve);
        *curve = NULL;
    }
    free(keys);
    free(spare);
    return result;
}

// Puts `count` of at most `size` neighbours into bit-reversed order, so that any first part is spread
// evenly.
static void shuffle(const uint32_t *sorted, size_t count, size_t size, uint32_t *shuffled)
{
    size_t next = 0;
    for (size_t i = 0; i < size; i++) {
        size_t from = 0;
        for (size_t bit = 1; bit < size; bit *= 2)
            from = 2 * from + (i & bit ? 1 : 0);
        if (from < count)
            shuffled[next++] = sorted[from];
    }
}

// How many of the points at `sorted`, `most` or fewer, make the next block: storage in one block would
// be imprecise where distances or radii within it are very different.
static size_t block_size(const struct orl_points *points, const uint32_t *sorted, size_t most)
{
    struct point_range range = orl_point_range_none();
    for (size_t i = 0; i < most; i++) {
        uint32_t point = sorted[i];
        orl_point_range_add(&range, points->position[point], points->radius[point]);
        if (i > 0 && !orl_point_range_is_precise(&range))
            return i;
    }
    return most;
}

// Divides sorted points into blocks, each filled up to `size` entries without a point.
static size_t make_blocks(const struct orl_points *points, const uint32_t *sorted, size_t count,
                          size_t size, uint32_t *order, size_t capacity)
{
    size_t to = 0, first = 0;
    while (first < count) {
        size_t left = count - first, needed = (left + size - 1) / size * size;
        size_t here = left < size ? left : size;
        if (to + needed + size <= capacity) // there is room for one more block
            here = block_size(points, sorted + first, here);
        shuffle(sorted + first, here, size, order + to);
        for (size_t i = here; i < size; i++)
            order[to + i] = UINT32_MAX;
        to += size;
        first += here;
    }
    return to;
}

enum orl_result orl_point_order(const struct orl_log *log, const struct orl_points *points,
                                const struct point_cube *cube, size_t size, uint32_t **order,
                                size_t *count)
{
    size_t blocks = points->count / size + 1, used = 0;
    size_t capacity = (blocks + blocks / SPLITS + SPLITS) * size;
    struct point_cube own;
    uint32_t *curve = NULL;
    *count = 0;
    *order = NULL;
    if (!cube)
        ORL_TRY(orl_point_cube_find(log, points, &own));
    ORL_TRY(sort_points(log, points, cube ? cube : &own, &curve, &used));
    *order = orl_array(log, capacity, sizeof **order);
    if (*order)
        *count = make_blocks(points, curve, used, size, *order, capacity);
    free(curve);
    return *order ? ORL_OK : ORL_ERR_MEMORY;
}

// --- blocks ---

struct point_frame orl_point_block_frame(const float texels[ORL_BLOCK_VEC4S][4])
{
    return (struct point_frame){{texels[2][0], texels[2][1], texels[2][2]}, texels[2][3]};
}

void orl_point_block_make(const struct orl_points *points, const uint32_t *order,
                          struct point_block *block)
{
    struct point_range range = orl_point_range_none(), drawn = range; // as codes have the positions
    size_t count = 0;
    for (; count < BLOCK && order[count] != UINT32_MAX; count++)
        orl_point_range_add(&range, points->position[order[count]], points->radius[order[count]]);
    const struct point_frame frame = orl_point_frame(&range);
    for (size_t i = 0; i < BLOCK; i++) {
        size_t from = order[i];
        float position[3];
        block->codes[i] = orl_point_code_none;
        if (i >= count)
            continue;
        block->codes[i] = orl_point_encode(&frame, points->position[from], points->normal[from],
                                           points->color[from], points->radius[from]);
        orl_point_decode_position(&frame, block->codes[i].geometry, position);
        orl_point_range_add(&drawn, position, 0);
    }
    orl_point_range_box(&drawn, block->texels[0], block->texels[1]);
    block->texels[0][3] = 0;
    block->texels[1][3] = (float)count;
    memcpy(block->texels[2], frame.origin, sizeof frame.origin);
    block->texels[2][3] = frame.step;
}
