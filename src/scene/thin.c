#include "scene/thin.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "scene/nearest_points.h"

// Sets alone[i] for the points of `thin` without a near point in the other cloud.
static enum orl_result find_alone(const struct orl_log *log, const struct orl_thin_params *params,
                                  const struct orl_points *points, const struct orl_points *thin,
                                  bool *alone)
{
    int *found = orl_array(log, thin->count, sizeof *found);
    float *dist2 = orl_array(log, thin->count, sizeof *dist2);
    enum orl_result result = found && dist2 ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_points_nearest(log, points, thin, found, dist2);
    for (size_t i = 0; result == ORL_OK && i < thin->count; i++) {
        // The nearest point is often in both clouds and exactly one radius away. The margin makes
        // it count as near despite rounding.
        float room = params->spacing * thin->radius[i] * (1 + 1e-5f);
        alone[i] = dist2[i] > room * room;
    }
    free(found);
    free(dist2);
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

// How much the depth of a point's tangent plane changes within a pixel, as a fraction of it. The
// plane n . p = d has depth d / (n . ray), and a pixel changes the ray by 1 / focal length. Angles
// so flat that normals say little about them count as MOST_SLOPE.
static double slope_of(const struct orl_view *view, const float position[3], const float normal[3])
{
    static const double MOST_SLOPE = 0.1;
    double n[3] = {0}, p[3], across, facing;
    for (int i = 0; i < 3; i++) {
        p[i] = view->cam_from_world.t[i];
        for (int k = 0; k < 3; k++) {
            n[i] += view->cam_from_world.r[i][k] * (double)normal[k];
            p[i] += view->cam_from_world.r[i][k] * (double)position[k];
        }
    }
    across = fabs(n[0]) / view->camera.fx + fabs(n[1]) / view->camera.fy;
    facing = fabs(n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) / fabs(p[2]);
    return across < MOST_SLOPE * facing ? across / facing : across > 0 ? MOST_SLOPE : 0;
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
        double behind = (double)depth->f32[at] / z - 1 - (double)tolerance;
        if (behind > 0 && behind > slope_of(&scaled, p, points->normal[i]) &&
            seen_past[i] < UINT16_MAX)
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
