#include "scene/nearest_points.h"

#include <flann/flann.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

#include "core/memory.h"

// --- points at the same position ---

// A hash table of positions by open addressing: 1 + the first point there; 0: free.
static size_t slot_of(const struct orl_points *points, const uint32_t *table, size_t slots, size_t i)
{
    float p[3];
    for (int k = 0; k < 3; k++)
        p[k] = points->position[i][k] + 0.0f; // -0 is 0
    size_t slot = XXH3_64bits(p, sizeof p) & (slots - 1);
    while (table[slot]) {
        const float *other = points->position[table[slot] - 1];
        if (other[0] == p[0] && other[1] == p[1] && other[2] == p[2])
            break;
        slot = (slot + 1) & (slots - 1);
    }
    return slot;
}

static enum orl_result take(const struct orl_log *log, const struct orl_points *points,
                            const bool *left_out, struct few_alike *few)
{
    few->index = orl_array(log, few->count, sizeof *few->index);
    few->own = orl_array(log, few->count, sizeof *few->own);
    ORL_TRY_MEMORY(few->index && few->own);
    size_t to = 0;
    for (size_t i = 0; i < points->count; i++) {
        if (left_out[i])
            continue;
        few->index[to] = (int)i;
        memcpy(few->own[to++], points->position[i], sizeof few->own[0]);
    }
    few->position = (const float(*)[3])few->own;
    return ORL_OK;
}

enum orl_result orl_points_few_alike(const struct orl_log *log, const struct orl_points *points,
                                     unsigned most, struct few_alike *few)
{
    size_t slots = 16;
    while (slots < 2 * points->count)
        slots *= 2;
    *few = (struct few_alike){.position = (const float(*)[3])points->position,
                              .count = points->count};
    uint32_t *table = orl_array(log, slots, sizeof *table);
    uint8_t *copies = orl_array(log, points->count, sizeof *copies); // at the first point there
    bool *left_out = orl_array(log, points->count, sizeof *left_out);
    enum orl_result result = table && copies && left_out ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < points->count; i++) {
        size_t slot = slot_of(points, table, slots, i);
        if (!table[slot])
            table[slot] = (uint32_t)i + 1;
        uint8_t *here = &copies[table[slot] - 1];
        left_out[i] = *here >= most;
        few->count -= left_out[i];
        *here = (uint8_t)(*here + !left_out[i]);
    }
    free(table);
    free(copies);
    if (result == ORL_OK && few->count < points->count)
        result = take(log, points, left_out, few);
    free(left_out);
    if (result != ORL_OK)
        orl_few_alike_finish(few);
    return result;
}

void orl_few_alike_finish(struct few_alike *few)
{
    free(few->index);
    free(few->own);
    *few = (struct few_alike){0};
}

// --- the search ---

static struct FLANNParameters parameters(void)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    struct FLANNParameters flann = DEFAULT_FLANN_PARAMETERS;
    flann.algorithm = FLANN_INDEX_KDTREE_SINGLE;
    flann.checks = FLANN_CHECKS_UNLIMITED; // an exact search
    flann.sorted = 1;
    flann.leaf_max_size = 10;
    flann.log_level = FLANN_LOG_NONE;
    flann.cores = cores > 0 && cores < 256 ? (int)cores : 2;
    return flann;
}

enum orl_result orl_point_search_open(const struct orl_log *log, const struct orl_points *points, int neighbours,
                                      struct point_search *search)
{
    struct FLANNParameters flann = parameters();
    float speedup;
    *search = (struct point_search){.log = log, .neighbours = neighbours};
    ORL_TRY(orl_points_few_alike(log, points, (unsigned)neighbours, &search->few));
    search->index = flann_build_index((float *)(uintptr_t)search->few.position, (int)search->few.count, 3, &speedup,
                                      &flann);
    return search->index ? ORL_OK
                         : orl_fail(log, ORL_ERR_EXTERNAL, "FLANN cannot index %zu points", search->few.count);
}

void orl_point_search_close(struct point_search *search)
{
    struct FLANNParameters flann = parameters();
    if (search->index)
        flann_free_index(search->index, &flann);
    orl_few_alike_finish(&search->few);
}

enum orl_result orl_point_search_find(const struct point_search *search, float (*queries)[3], size_t count, int *found,
                                      float *dist2)
{
    struct FLANNParameters flann = parameters();
    const struct few_alike *few = &search->few;
    size_t all = count * (size_t)search->neighbours;
    memset(found, 0xff, all * sizeof *found); // -1: no neighbour
    if (flann_find_nearest_neighbors_index(search->index, *queries, (int)count, found, dist2, search->neighbours,
                                           &flann) != 0)
        return orl_fail(search->log, ORL_ERR_EXTERNAL, "FLANN cannot search its index");
    for (size_t i = 0; i < all; i++) {
        if (found[i] < 0 || (size_t)found[i] >= few->count)
            return orl_fail(search->log, ORL_ERR_EXTERNAL, "FLANN found a point that is not there");
        found[i] = few->index ? few->index[found[i]] : found[i];
    }
    return ORL_OK;
}

enum orl_result orl_points_nearest(const struct orl_log *log, const struct orl_points *points,
                                   const struct orl_points *queries, int *found, float *dist2)
{
    enum { CHUNK = 1 << 15 };
    if (points->count > ORL_SEARCH_POINTS_MAX)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%zu points are more than FLANN can index",
                        points->count);
    struct point_search search;
    enum orl_result result = orl_point_search_open(log, points, 1, &search);
    for (size_t first = 0; result == ORL_OK && first < queries->count; first += CHUNK) {
        size_t count = queries->count - first < CHUNK ? queries->count - first : CHUNK;
        result = orl_point_search_find(&search, queries->position + first, count, found + first, dist2 + first);
    }
    orl_point_search_close(&search);
    return result;
}
