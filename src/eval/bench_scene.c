// Views for the benchmark, and scenes with more or fewer points and photographs.
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "eval/bench_internal.h"

static size_t next_used(const struct orl_scene *scene, size_t from)
{
    while (from < scene->photo_count && scene->photos[from].test)
        from++;
    return from;
}

void orl_bench_choose_views(struct bench_job *job)
{
    const struct orl_scene *scene = job->scene;
    job->view_count = 0;
    for (size_t k = 0; k < BENCH_VIEWS_MAX; k++) {
        size_t a = next_used(scene, (2 * k + 1) * scene->photo_count / (2 * BENCH_VIEWS_MAX));
        size_t b = a < scene->photo_count ? next_used(scene, a + 1) : a;
        if (a == scene->photo_count)
            a = next_used(scene, 0);
        if (b == scene->photo_count)
            b = next_used(scene, 0);
        job->views[job->view_count++] =
            orl_view_interpolate(&scene->photos[a].view, &scene->photos[b].view, 0.5);
    }
}

struct orl_view orl_bench_resize_view(const struct orl_view *view, int width, int height)
{
    const struct orl_camera *c = &view->camera;
    double scale = fmax((double)width / c->width, (double)height / c->height);
    struct orl_view resized = *view;
    resized.camera = (struct orl_camera){
        .width = width, .height = height, .fx = c->fx * scale, .fy = c->fy * scale,
        .cx = 0.5 * width + (c->cx - 0.5 * c->width) * scale,
        .cy = 0.5 * height + (c->cy - 0.5 * c->height) * scale};
    return resized;
}

// Moves a copy of a point on the point's disc, which its copies fill evenly (Vogel's spiral).
static void spread(struct orl_points *points, size_t i, size_t copy, size_t copies, float radius)
{
    const float *n = points->normal[i];
    float axis[3] = {fabsf(n[0]) < 0.6f, fabsf(n[0]) >= 0.6f, 0}, u[3], v[3];
    float along = axis[0] * n[0] + axis[1] * n[1], length = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = axis[k] - along * n[k];
        length += u[k] * u[k];
    }
    length = length > 0 ? sqrtf(length) : 1;
    for (int k = 0; k < 3; k++)
        u[k] /= length;
    v[0] = n[1] * u[2] - n[2] * u[1];
    v[1] = n[2] * u[0] - n[0] * u[2];
    v[2] = n[0] * u[1] - n[1] * u[0];
    float angle = 2.3999632f * (float)copy;
    float far = 0.5f * radius * sqrtf(((float)copy + 0.5f) / (float)copies);
    for (int k = 0; k < 3; k++)
        points->position[i][k] += far * (cosf(angle) * u[k] + sinf(angle) * v[k]);
}

enum orl_result orl_bench_resample(const struct orl_log *log, const struct orl_points *all,
                                   size_t count, struct orl_points *points)
{
    enum orl_result result = orl_points_init(log, points, count);
    if (result != ORL_OK)
        return result;
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

void orl_bench_choose_photos(const struct orl_scene *scene, size_t count, bool *use)
{
    size_t train = 0, at = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        train += !scene->photos[i].test;
    for (size_t i = 0; i < scene->photo_count; i++) {
        use[i] = !scene->photos[i].test && (at + 1) * count / train > at * count / train;
        at += !scene->photos[i].test;
    }
}
