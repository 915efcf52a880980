// What gets worse about points.
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/vec3.h"
#include "eval/stress_internal.h"

// --- random numbers ---

// SplitMix64 (Steele, Lea and Flood 2014).
static uint64_t mixed(uint64_t z)
{
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double orl_stress_uniform(uint64_t seed, uint64_t a, uint64_t b)
{
    return (double)(mixed(mixed(mixed(seed) ^ a) ^ b) >> 11) * 0x1p-53;
}

double orl_stress_normal(uint64_t seed, uint64_t a, uint64_t b)
{
    static const double two_pi = 6.283185307179586;
    double u = 1 - orl_stress_uniform(seed, a, 2 * b), v = orl_stress_uniform(seed, a, 2 * b + 1);
    return sqrt(-2 * log(u)) * cos(two_pi * v); // Box and Muller 1958
}

// --- points ---

enum orl_result orl_stress_fewer_points(struct stress_case *c, double level, uint64_t seed)
{
    struct orl_points *points = &c->scene.points;
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i++)
        if (orl_stress_uniform(seed, i, 0) >= level / 100)
            orl_points_copy(points, i, points, kept++);
    points->count = kept;
    return ORL_OK;
}

static void move_along_ray(float position[3], const struct orl_view *view, double factor)
{
    double eye[3];
    orl_pose_centre(&view->cam_from_world, eye);
    for (int k = 0; k < 3; k++)
        position[k] = (float)(eye[k] + factor * ((double)position[k] - eye[k]));
}

enum orl_result orl_stress_noisy_points(struct stress_case *c, double level, uint64_t seed)
{
    struct orl_points *points = &c->scene.points;
    for (size_t i = 0; i < points->count; i++) {
        int pixel[2], photo = orl_stress_photo_of(c, i, pixel);
        if (photo >= 0)
            move_along_ray(points->position[i], &c->scene.photos[photo].view,
                           fmax(0.1, 1 + level / 100 * orl_stress_normal(seed, i, 0)));
    }
    return ORL_OK;
}

// Adds points in mid-air on the rays of other points, so that `level` percent are outliers.
enum orl_result orl_stress_outliers(struct stress_case *c, double level, uint64_t seed)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    static const double nearest = 0.3, farthest = 0.95; // shares of the way to the surface
    struct orl_points all, *points = &c->scene.points;
    size_t count = points->count, extra = (size_t)((double)count * level / (100 - level));
    enum orl_result result = orl_points_init(log, &all, count + extra);
    for (size_t i = 0; result == ORL_OK && i < count + extra; i++) {
        size_t like = i < count ? i : (size_t)(orl_stress_uniform(seed, i, 0) * (double)count);
        int pixel[2], photo;
        orl_points_copy(points, like, &all, i);
        if (i < count || (photo = orl_stress_photo_of(c, like, pixel)) < 0)
            continue;
        size_t color = (size_t)(orl_stress_uniform(seed, i, 1) * (double)count);
        memcpy(all.color[i], points->color[color], 3);
        all.photographs[i] = 0; // no stereo has found it
        move_along_ray(all.position[i], &c->scene.photos[photo].view,
                       nearest + (farthest - nearest) * orl_stress_uniform(seed, i, 2));
    }
    if (result == ORL_OK) {
        orl_points_finish(points);
        *points = all;
    }
    return result;
}
