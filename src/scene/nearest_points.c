#include "scene/nearest_points.h"

#include <flann/flann.h>
#include <limits.h>
#include <string.h>
#include <unistd.h>

#include "scene/alike_points.h"

enum { CHUNK = 1 << 15 };

static enum orl_result search(const struct orl_log *log, flann_index_t index,
                              struct FLANNParameters *flann, const struct few_alike *points,
                              const struct orl_points *queries, int *found, float *dist2)
{
    for (size_t first = 0; first < queries->count; first += CHUNK) {
        size_t count = queries->count - first < CHUNK ? queries->count - first : CHUNK;
        memset(found + first, 0xff, count * sizeof *found); // -1: no neighbour
        if (flann_find_nearest_neighbors_index(index, queries->position[first], (int)count,
                                               found + first, dist2 + first, 1, flann) != 0)
            return orl_fail(log, ORL_ERR_EXTERNAL, "FLANN cannot search its index");
    }
    for (size_t i = 0; i < queries->count; i++)
        if ((found[i] = orl_few_alike_point(points, found[i])) < 0)
            return orl_fail(log, ORL_ERR_EXTERNAL, "FLANN found a point that is not there");
    return ORL_OK;
}

enum orl_result orl_points_nearest(const struct orl_log *log, const struct orl_points *points,
                                   const struct orl_points *queries, int *found, float *dist2)
{
    if (points->count > INT_MAX / 64 || queries->count > INT_MAX / 64)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%zu points are more than FLANN can index",
                        points->count > queries->count ? points->count : queries->count);
    float speedup;
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    struct FLANNParameters flann = DEFAULT_FLANN_PARAMETERS;
    flann.algorithm = FLANN_INDEX_KDTREE_SINGLE;
    flann.checks = FLANN_CHECKS_UNLIMITED; // an exact search
    flann.leaf_max_size = 10;
    flann.log_level = FLANN_LOG_NONE;
    flann.cores = cores > 0 && cores < 256 ? (int)cores : 2;
    struct few_alike few;
    enum orl_result result = orl_points_few_alike(log, points, 1, &few);
    if (result != ORL_OK)
        return result;
    flann_index_t index = flann_build_index((float *)(uintptr_t)few.position, (int)few.count, 3,
                                            &speedup, &flann);
    result = index ? search(log, index, &flann, &few, queries, found, dist2)
                   : orl_fail(log, ORL_ERR_EXTERNAL, "FLANN cannot index %zu points", few.count);
    if (index)
        flann_free_index(index, &flann);
    orl_few_alike_finish(&few);
    return result;
}
