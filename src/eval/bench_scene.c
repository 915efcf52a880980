// Views for the benchmark, and scenes with more or fewer points.
#include <math.h>

#include "core/memory.h"
#include "core/vec3.h"
#include "eval/bench_internal.h"
#include "oriel/path.h"

static size_t next_used(const struct orl_scene *scene, size_t from)
{
    while (from < scene->photo_count && scene->photos[from].test)
        from++;
    return from;
}

void orl_bench_choose_views(struct bench_job *job)
{
    const struct orl_scene *scene = job->bench->scene;
    for (size_t k = 0; k < BENCH_VIEWS; k++) {
        size_t a = next_used(scene, (2 * k + 1) * scene->photo_count / (2 * BENCH_VIEWS));
        size_t b = a < scene->photo_count ? next_used(scene, a + 1) : a;
        if (a == scene->photo_count)
            a = next_used(scene, 0);
        if (b == scene->photo_count)
            b = next_used(scene, 0);
        job->views[k] =
            orl_view_interpolate(&scene->photos[a].view, &scene->photos[b].view, 0.5);
    }
}

struct orl_view orl_bench_view(const struct bench_job *job, size_t number, struct orl_size size)
{
    struct orl_view view = job->views[number % BENCH_VIEWS];
    view.camera = orl_camera_reframed(&view.camera, size.width, size.height);
    return view;
}

// Moves a copy of a point on the point's disc, which its copies fill evenly (Vogel's spiral).
static void spread(struct orl_points *points, size_t i, size_t copy, size_t copies, float radius)
{
    const float *normal = points->normal[i];
    const double n[3] = {(double)normal[0], (double)normal[1], (double)normal[2]};
    const double axis[3] = {fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0};
    double u[3], v[3], angle = 2.3999632 * (double)copy;
    double far = 0.5 * (double)radius * sqrt(((double)copy + 0.5) / (double)copies);
    orl_cross3(n, axis, u);
    orl_normalize3(u);
    orl_cross3(n, u, v);
    for (int k = 0; k < 3; k++)
        points->position[i][k] += (float)(far * (cos(angle) * u[k] + sin(angle) * v[k]));
}

enum orl_result orl_bench_resample(const struct orl_log *log, const struct orl_points *all,
                                   size_t count, struct orl_points *points)
{
    ORL_TRY(orl_points_init(log, points, count));
    // The total area stays the same: fewer points are larger.
    float scale = sqrtf((float)all->count / (float)count);
    for (size_t i = 0; i < count; i++) {
        size_t from = (size_t)((double)i * (double)all->count / (double)count);
        from = from < all->count ? from : all->count - 1;
        orl_points_copy(all, from, points, i);
        if (count > all->count) {
            size_t first = (size_t)ceil((double)from * (double)count / (double)all->count);
            spread(points, i, i - first, count / all->count + 1, all->radius[from]);
        }
        points->radius[i] *= scale;
    }
    return ORL_OK;
}
