#include "scene/point_radii.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/order.h"
#include "scene/nearest_points.h"

enum { CHUNK = 1 << 15 }; // points between two reports of progress and checks for cancellation

struct search {
    const struct orl_log *log;
    struct orl_points *points;
    double (*viewers)[3]; // places of the cameras
    size_t viewer_count;
    int neighbours; // excluding the point itself
    float overlap;
    struct point_search near;
    int *found;   // CHUNK * (neighbours + 1)
    float *dist2; // squared distances, as many
};

// Eigenvector of the smallest eigenvalue of a symmetric matrix, by Jacobi
// rotations (Golub and Van Loan 8.5).
static void smallest_axis(double m[3][3], double axis[3])
{
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 12; sweep++) {
        for (int p = 0; p < 2; p++) {
            for (int q = p + 1; q < 3; q++) {
                if (fabs(m[p][q]) < 1e-300)
                    continue;
                double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
                double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < 3; k++) {
                    double a = m[k][p], b = m[k][q];
                    m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
                }
                for (int k = 0; k < 3; k++) {
                    double a = m[p][k], b = m[q][k];
                    m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
                    double va = v[k][p], vb = v[k][q];
                    v[k][p] = c * va - s * vb, v[k][q] = s * va + c * vb;
                }
            }
        }
    }
    int least = m[1][1] < m[0][0];
    if (m[2][2] < m[least][least])
        least = 2;
    for (int k = 0; k < 3; k++)
        axis[k] = v[k][least];
}

static size_t nearest_viewer(const struct search *s, const float p[3], double *distance)
{
    size_t best = 0;
    double best2 = INFINITY;
    for (size_t i = 0; i < s->viewer_count; i++) {
        double d2 = 0;
        for (int k = 0; k < 3; k++)
            d2 += (s->viewers[i][k] - (double)p[k]) * (s->viewers[i][k] - (double)p[k]);
        if (d2 < best2)
            best = i, best2 = d2;
    }
    *distance = sqrt(best2);
    return best;
}

// Fits a plane to the point and its neighbours by principal components and sets the normal.
static void fit_normal(const struct search *s, size_t i, const int *found)
{
    const float *p = s->points->position[i];
    double mean[3] = {0}, m[3][3] = {{0}}, axis[3];
    int count = s->neighbours + 1;
    for (int j = 0; j < count; j++)
        for (int k = 0; k < 3; k++)
            mean[k] += ((double)s->points->position[found[j]][k] - (double)p[k]) / count;
    for (int j = 0; j < count; j++) {
        double d[3];
        for (int k = 0; k < 3; k++)
            d[k] = (double)s->points->position[found[j]][k] - (double)p[k] - mean[k];
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                m[a][b] += d[a] * d[b];
    }
    smallest_axis(m, axis);
    double sign = 1;
    if (s->viewer_count) {
        double distance, facing = 0;
        const double *viewer = s->viewers[nearest_viewer(s, p, &distance)];
        for (int k = 0; k < 3; k++)
            facing += axis[k] * (viewer[k] - (double)p[k]);
        sign = facing < 0 ? -1 : 1;
    }
    for (int k = 0; k < 3; k++)
        s->points->normal[i][k] = (float)(sign * axis[k]);
}

static enum orl_result search_chunk(struct search *s, size_t first, size_t count)
{
    size_t columns = (size_t)s->neighbours + 1;
    ORL_TRY(orl_point_search_find(&s->near, s->points->position + first, count, s->found, s->dist2));
    for (size_t i = 0; i < count; i++) {
        // The point itself is found too, at distance zero, so the last column is the k-th
        // neighbour.
        s->points->radius[first + i] =
            s->overlap * sqrtf(s->dist2[i * columns + columns - 1]);
        const float *n = s->points->normal[first + i];
        if (n[0] == 0 && n[1] == 0 && n[2] == 0)
            fit_normal(s, first + i, s->found + i * columns);
    }
    return ORL_OK;
}

static bool usable(float radius)
{
    return radius > 0 && isfinite(radius);
}

// Sets the radii of points that coincide with all their neighbours.
static enum orl_result fill_radii(struct search *s, size_t count)
{
    struct orl_points *points = s->points;
    size_t known = 0;
    float *sorted = orl_array(s->log, count, sizeof *sorted);
    ORL_TRY_MEMORY(sorted);
    for (size_t i = 0; i < count; i++)
        if (usable(points->radius[i]))
            sorted[known++] = points->radius[i];
    qsort(sorted, known, sizeof *sorted, orl_order_floats);
    double distance = 1; // without any known radius: a hundredth of the distance to the viewer
    if (!known && s->viewer_count)
        nearest_viewer(s, points->position[0], &distance);
    float median = known ? sorted[known / 2] : (float)(0.01 * (distance > 0 ? distance : 1));
    for (size_t i = 0; i < count; i++)
        if (!usable(points->radius[i]))
            points->radius[i] = median;
    free(sorted);
    return ORL_OK;
}

enum orl_result orl_points_set_radii(const struct orl_log *log,
                                     const struct orl_progress *progress,
                                     const struct orl_radii_params *params,
                                     const struct orl_view *views, size_t view_count,
                                     struct orl_points *points)
{
    orl_points_drop_unusable(log, points); // FLANN fails when distances overflow
    return orl_points_set_some_radii(log, progress, params, views, view_count, points->count,
                                     points);
}

enum orl_result orl_points_set_some_radii(const struct orl_log *log,
                                          const struct orl_progress *progress,
                                          const struct orl_radii_params *params,
                                          const struct orl_view *views, size_t view_count,
                                          size_t own, struct orl_points *points)
{
    ORL_REQUIRE(log, params->neighbours >= 1 && params->neighbours <= 64);
    ORL_REQUIRE(log, params->overlap > 0 && params->overlap <= 8);
    if (own == 0)
        return ORL_OK;
    if (points->count > ORL_SEARCH_POINTS_MAX)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%zu points are more than FLANN can index",
                        points->count);
    size_t others = points->count - 1;
    struct search s = {
        .log = log, .points = points, .viewer_count = view_count,
        .neighbours = others < (size_t)params->neighbours ? (int)others : params->neighbours,
        .overlap = params->overlap};
    s.viewers = orl_array(log, view_count, sizeof *s.viewers);
    for (size_t i = 0; s.viewers && i < view_count; i++)
        orl_pose_centre(&views[i].cam_from_world, s.viewers[i]);
    s.found = orl_array(log, (size_t)CHUNK * ((size_t)s.neighbours + 1), sizeof *s.found);
    s.dist2 = orl_array(log, (size_t)CHUNK * ((size_t)s.neighbours + 1), sizeof *s.dist2);
    enum orl_result result = s.viewers && s.found && s.dist2 ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_point_search_open(log, points, s.neighbours + 1, &s.near));
    for (size_t first = 0; result == ORL_OK && first < own; first += CHUNK) {
        orl_progress_report(progress, "radii", (double)first, (double)own, NULL);
        size_t count = own - first < CHUNK ? own - first : CHUNK;
        result = orl_progress_cancelled(progress) ? ORL_ERR_CANCELLED
                                                  : search_chunk(&s, first, count);
    }
    ORL_THEN(result, fill_radii(&s, own));
    if (result == ORL_OK)
        orl_progress_report(progress, "radii", (double)own, (double)own, NULL);
    orl_point_search_close(&s.near);
    free(s.viewers);
    free(s.found);
    free(s.dist2);
    return result;
}
