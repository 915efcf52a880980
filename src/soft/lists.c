#include "soft/lists.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "oriel/gpu.h"

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, KEY_BITS = 32 };

// A range of tiles, each end included.
struct tiles {
    int left, top, right, bottom;
};

static struct tiles tiles_of(const uint32_t bounds[ORL_SOFT_BOUND_WORDS])
{
    return (struct tiles){(int)(bounds[1] & 0xffff), (int)(bounds[1] >> 16), (int)(bounds[2] & 0xffff),
                          (int)(bounds[2] >> 16)};
}

static size_t area(struct tiles t)
{
    return (size_t)(t.right - t.left + 1) * (size_t)(t.bottom - t.top + 1);
}

// Sorts the splats that are seen by depth (radix sort; bits of floats above 0 have their order). Returns how
// many there are.
static size_t sort(const uint32_t (*bounds)[ORL_SOFT_BOUND_WORDS], size_t count, struct orl_soft_lists *lists)
{
    size_t seen = 0;
    for (size_t i = 0; i < count; i++)
        if (bounds[i][0])
            lists->order[seen++] = (struct orl_soft_key){bounds[i][0], (int)i};
    for (int shift = 0; shift < KEY_BITS; shift += DIGIT_BITS) {
        size_t starts[DIGITS + 1] = {0};
        for (size_t i = 0; i < seen; i++)
            starts[(lists->order[i].depth >> shift & (DIGITS - 1)) + 1]++;
        for (int d = 0; d < DIGITS; d++)
            starts[d + 1] += starts[d];
        for (size_t i = 0; i < seen; i++)
            lists->spare[starts[lists->order[i].depth >> shift & (DIGITS - 1)]++] = lists->order[i];
        struct orl_soft_key *sorted = lists->spare;
        lists->spare = lists->order;
        lists->order = sorted;
    }
    return seen;
}

static enum orl_result reserve(const struct orl_log *log, size_t count, struct orl_soft_lists *lists)
{
    if (count <= lists->order_capacity)
        return ORL_OK;
    free(lists->order);
    free(lists->spare);
    lists->order = orl_array(log, count, sizeof *lists->order);
    lists->spare = orl_array(log, count, sizeof *lists->spare);
    lists->order_capacity = lists->order && lists->spare ? count : 0;
    return lists->order_capacity ? ORL_OK : ORL_ERR_MEMORY;
}

size_t orl_soft_tiles(int width, int height)
{
    return (size_t)orl_groups((size_t)width, ORL_SOFT_TILE) * orl_groups((size_t)height, ORL_SOFT_TILE);
}

enum orl_result orl_soft_lists_make(const struct orl_log *log, const uint32_t (*bounds)[ORL_SOFT_BOUND_WORDS],
                                    size_t count, int width, int height, struct orl_soft_lists *lists)
{
    const size_t across = orl_groups((size_t)width, ORL_SOFT_TILE), tiles = orl_soft_tiles(width, height);
    size_t entries = 0;
    for (size_t i = 0; i < count; i++)
        entries += bounds[i][0] ? area(tiles_of(bounds[i])) : 0;
    if (entries + tiles + count + 2 > INT_MAX)
        return orl_fail(log, ORL_ERR_DATA, "too many soft splats for one view");
    ORL_TRY(reserve(log, count, lists));
    ORL_TRY(orl_grow(log, (void **)&lists->listed, &lists->listed_capacity, tiles + 1 + entries, sizeof(int)));
    ORL_TRY(orl_grow(log, (void **)&lists->places, &lists->places_capacity, count + 1 + entries, sizeof(int)));
    lists->tiles = tiles;
    lists->entries = entries;
    const size_t seen = lists->seen = sort(bounds, count, lists);

    // Counts of the tiles, then where their lists begin; places[] likewise.
    int *starts = lists->listed, *places = lists->places;
    memset(starts, 0, (tiles + 1) * sizeof *starts);
    for (size_t k = 0; k < seen; k++) {
        struct tiles t = tiles_of(bounds[lists->order[k].splat]);
        for (int y = t.top; y <= t.bottom; y++)
            for (int x = t.left; x <= t.right; x++)
                starts[(size_t)y * across + (size_t)x]++;
    }
    int at = (int)tiles + 1;
    for (size_t i = 0; i <= tiles; i++) {
        int here = starts[i];
        starts[i] = at;
        at += here;
    }
    places[0] = (int)count + 1;
    for (size_t i = 0; i < count; i++)
        places[i + 1] = places[i] + (int)(bounds[i][0] ? area(tiles_of(bounds[i])) : 0);

    for (size_t k = 0; k < seen; k++) {
        int splat = lists->order[k].splat, place = places[splat];
        struct tiles t = tiles_of(bounds[splat]);
        for (int y = t.top; y <= t.bottom; y++)
            for (int x = t.left; x <= t.right; x++) {
                int entry = starts[(size_t)y * across + (size_t)x]++;
                lists->listed[entry] = splat;
                places[place++] = entry - (int)tiles - 1;
            }
    }
    memmove(starts + 1, starts, tiles * sizeof *starts); // each start has become the next list's
    starts[0] = (int)tiles + 1;
    return ORL_OK;
}

void orl_soft_lists_finish(struct orl_soft_lists *lists)
{
    free(lists->listed);
    free(lists->places);
    free(lists->order);
    free(lists->spare);
    memset(lists, 0, sizeof *lists);
}
