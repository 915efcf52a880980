#include "scene/thin.h"

#include <flann/flann.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"

enum { CHUNK = 1 << 15 };

struct nearest {
    struct FLANNParameters flann;
    flann_index_t index;
    int *found;   // CHUNK
    float *dist2; // CHUNK
};

static enum orl_result open_nearest(const struct orl_log *log, const struct orl_points *points,
                                    struct nearest *n)
{
    float speedup;
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    n->flann = DEFAULT_FLANN_PARAMETERS;
    n->flann.algorithm = FLANN_INDEX_KDTREE_SINGLE;
    n->flann.checks = FLANN_CHECKS_UNLIMITED; // an exact search
    n->flann.leaf_max_size = 10;
    n->flann.log_level = FLANN_LOG_NONE;
    n->flann.cores = cores > 0 && cores < 256 ? (int)cores : 2;
    n->found = orl_array(log, CHUNK, sizeof *n->found);
    n->dist2 = orl_array(log, CHUNK, sizeof *n->dist2);
    if (!n->found || !n->dist2)
        return ORL_ERR_MEMORY;
    n->index = flann_build_index(&points->position[0][0], (int)points->count, 3, &speedup,
                                 &n->flann);
    return n->index ? ORL_OK
                    : orl_fail(log, ORL_ERR_EXTERNAL, "FLANN cannot index %zu points",
                               points->count);
}

static void close_nearest(struct nearest *n)
{
    if (n->index)
        flann_free_index(n->index, &n->flann);
    free(n->found);
    free(n->dist2);
}

// Sets alone[i] for the points of `thin` without a near point in the other cloud.
static enum orl_result find_alone(const struct orl_log *log, const struct orl_thin_params *params,
                                  const struct orl_points *points, const struct orl_points *thin,
                                  bool *alone)
{
    struct nearest n = {0};
    enum orl_result result = open_nearest(log, points, &n);
    for (size_t first = 0; result == ORL_OK && first < thin->count; first += CHUNK) {
        size_t count = thin->count - first < CHUNK ? thin->count - first : CHUNK;
        memset(n.found, 0xff, count * sizeof *n.found); // -1: no neighbour
        if (flann_find_nearest_neighbors_index(n.index, thin->position[first], (int)count,
                                               n.found, n.dist2, 1, &n.flann) != 0)
            result = orl_fail(log, ORL_ERR_EXTERNAL, "FLANN cannot search its index");
        for (size_t i = 0; result == ORL_OK && i < count; i++)
            if (n.found[i] < 0 || (size_t)n.found[i] >= points->count)
                result = orl_fail(log, ORL_ERR_EXTERNAL, "FLANN found a point that is not there");
        for (size_t i = 0; result == ORL_OK && i < count; i++) {
            // The nearest point is often in both clouds and exactly one radius away. The margin
            // makes it count as near despite rounding.
            float room = params->spacing * thin->radius[first + i] * (1 + 1e-5f);
            alone[first + i] = n.dist2[i] > room * room;
        }
    }
    close_nearest(&n);
    return result;
}

static enum orl_result append(const struct orl_log *log, const struct orl_points *thin,
                              const bool *take, size_t taken, struct orl_points *points)
{
    struct orl_points all;
    enum orl_result result = orl_points_init(log, &all, points->count + taken);
    if (result != ORL_OK)
        return result;
    size_t at = 0;
    for (size_t i = 0; i < points->count; i++)
        orl_points_copy(points, i, &all, at++);
    for (size_t i = 0; i < thin->count; i++)
        if (take[i])
            orl_points_copy(thin, i, &all, at++);
    orl_points_finish(points);
    *points = all;
    return ORL_OK;
}

enum orl_result orl_points_add_thin(const struct orl_log *log, const struct orl_thin_params *params,
                                    struct orl_points *thin, struct orl_points *points)
{
    ORL_REQUIRE(log, params->spacing > 0 && params->spacing <= 64);
    orl_points_drop_unusable(log, points); // FLANN fails when distances overflow
    orl_points_drop_unusable(log, thin);
    if (points->count > INT_MAX / 64 || thin->count > INT_MAX / 64)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%zu points are more than FLANN can index",
                        points->count > thin->count ? points->count : thin->count);
    bool *take = orl_array(log, thin->count, sizeof *take);
    if (!take)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    if (points->count)
        result = find_alone(log, params, points, thin, take);
    size_t taken = 0;
    for (size_t i = 0; i < thin->count; i++) {
        take[i] = (take[i] || !points->count) && thin->photographs[i] <= params->photographs;
        taken += take[i];
    }
    if (result == ORL_OK)
        result = append(log, thin, take, taken, points);
    free(take);
    return result;
}

void orl_points_count_seen_past(const struct orl_points *points, const struct orl_view *view,
                                const struct orl_image *depth, float tolerance,
                                uint16_t *seen_past)
{
    const struct orl_camera camera = orl_camera_resized(&view->camera, depth->width, depth->height);
    const struct orl_view scaled = {camera, view->cam_from_world};
    for (size_t i = 0; i < points->count; i++) {
        const float *p = points->position[i];
        const double world[3] = {(double)p[0], (double)p[1], (double)p[2]};
        double pixel[2], z;
        if (!orl_view_project(&scaled, world, pixel, &z) || !(pixel[0] >= 0) ||
            !(pixel[1] >= 0) || !(pixel[0] < depth->width) || !(pixel[1] < depth->height))
            continue;
        size_t at = (size_t)pixel[1] * (size_t)depth->width + (size_t)pixel[0];
        if ((double)depth->f32[at] > z * (1 + (double)tolerance) && seen_past[i] < UINT16_MAX)
            seen_past[i]++;
    }
}

void orl_points_drop_seen_past(const uint16_t *seen_past, struct orl_points *points)
{
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i++)
        if (2 * seen_past[i] < points->photographs[i] || !points->photographs[i])
            orl_points_copy(points, i, points, kept++);
    points->count = kept;
}
