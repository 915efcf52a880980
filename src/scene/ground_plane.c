#include "scene/ground_plane.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/cholesky.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "scene/upright.h"

enum {
    POINTS_MAX = 4096,
    PHOTOS_MAX = 64,
    TRIES = 8,   // planes for each point
    FITS = 8,    // of the best plane to the points in it
    STEP = 1009, // from one point of a plane to the next, in the sample
};

// Largest standard deviation of the photographs' heights, as a fraction of their mean height.
static const double HEIGHT_SPREAD = 0.2;
static const double TOLERANCE = 0.01; // distance of inliers, as a fraction of photo_distance
static const double BENEATH = 2;      // in tolerances: deeper points contradict the plane
static const double EXTENT = 1;       // smallest RMS spread of inliers, in mean heights
// Least mean absolute cosine between the plane's normal and the photographs' axis x or y.
static const double UPWARD_MIN = 0.85;
// Least cosine between the plane's normal and what the photographs have above: a ceiling is no ground.
static const double UP_MIN = -0.5;
// As fractions of all points.
static const double BENEATH_MAX = 0.005, SCORE_MIN = 0.003;
// Smallest cosine of a point's normal with the plane's for the point to lie in it. The feet of facades lie near a
// plane, and so do the lower edges of a thing on a turntable.
static const double ALIGNED_COSINE = 0.7;

struct sample {
    double (*position)[3], (*normal)[3];
    int count;
    const struct orl_pose *poses[PHOTOS_MAX];
    double centres[PHOTOS_MAX][3];
    int photo_count;
    double tolerance; // scene units
    double up[3];     // mean of the photographs, of those on their side no more than a guess
};

// Height of a point above the plane of struct orl_ground, in scene units; negative below it.
static double plane_height(const double plane[4], const double at[3])
{
    return orl_dot3(plane, at) + plane[3];
}

static void take_photos(const struct orl_scene *scene, struct sample *s)
{
    size_t train = 0, seen = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        train += !scene->photos[i].test;
    size_t step = (train + PHOTOS_MAX - 1) / PHOTOS_MAX;
    for (size_t i = 0; i < scene->photo_count; i++) {
        if (scene->photos[i].test || seen++ % step != 0)
            continue;
        s->poses[s->photo_count] = &scene->photos[i].view.cam_from_world;
        orl_pose_centre(s->poses[s->photo_count], s->centres[s->photo_count]);
        s->photo_count++;
    }
}

// Of the training photographs alone, unlike orl_scene_mean_up.
static void find_up(const struct orl_scene *scene, double up[3])
{
    for (size_t i = 0; i < scene->photo_count; i++) {
        struct orl_view view = orl_photo_upright(&scene->photos[i]);
        for (int k = 0; !scene->photos[i].test && k < 3; k++)
            up[k] -= view.cam_from_world.r[1][k];
    }
    orl_normalize3(up);
}

// The area of a disc as the nearest photograph sees it. Points lie closer together at outlines than on
// smooth surfaces, so that their number alone would not tell how much of a picture a plane fills.
static double seen_size(const struct sample *s, const struct orl_points *points, size_t i)
{
    const float *p = points->position[i];
    double nearest2 = INFINITY, radius = (double)points->radius[i];
    for (int n = 0; n < s->photo_count; n++) {
        const double *c = s->centres[n];
        const double to[3] = {(double)p[0] - c[0], (double)p[1] - c[1], (double)p[2] - c[2]};
        nearest2 = fmin(nearest2, orl_dot3(to, to));
    }
    return nearest2 > 0 ? radius * radius / nearest2 : 0;
}

static enum orl_result take_sample(const struct orl_log *log, const struct orl_scene *scene,
                                   struct sample *s)
{
    const struct orl_points *points = &scene->points;
    s->position = orl_array(log, POINTS_MAX, sizeof *s->position);
    s->normal = orl_array(log, POINTS_MAX, sizeof *s->normal);
    ORL_TRY_MEMORY(s->position && s->normal);
    s->tolerance = TOLERANCE * scene->photo_distance;
    take_photos(scene, s);
    find_up(scene, s->up);
    double total = 0, passed = 0;
    for (size_t i = 0; i < points->count; i++)
        total += seen_size(s, points, i);
    for (size_t i = 0; i < points->count && s->count < POINTS_MAX; i++) {
        passed += seen_size(s, points, i);
        if (passed * POINTS_MAX < (s->count + 0.5) * total)
            continue;
        for (int k = 0; k < 3; k++) {
            s->position[s->count][k] = (double)points->position[i][k];
            s->normal[s->count][k] = (double)points->normal[i][k];
        }
        s->count++;
    }
    return ORL_OK;
}

// Turns the plane's normal towards the photographs and returns their mean height above it; 0 when
// the plane cannot be the ground that they were taken from.
static double stood_height(const struct sample *s, double plane[4])
{
    double sum = 0, squares = 0, least = INFINITY, across[2] = {0};
    for (int i = 0; i < s->photo_count; i++)
        sum += plane_height(plane, s->centres[i]);
    for (int k = 0; sum < 0 && k < 4; k++)
        plane[k] = -plane[k];
    double mean = fabs(sum) / s->photo_count;
    for (int i = 0; i < s->photo_count; i++) {
        double height = plane_height(plane, s->centres[i]);
        squares += (height - mean) * (height - mean) / s->photo_count;
        least = fmin(least, height);
        for (int k = 0; k < 2; k++)
            across[k] += fabs(orl_dot3(s->poses[i]->r[k], plane)) / s->photo_count;
    }
    // A camera may be held upright or on its side, so x or y may be the vertical axis.
    bool level = fmax(across[0], across[1]) >= UPWARD_MIN && orl_dot3(plane, s->up) > UP_MIN;
    return level && least > 0 && sqrt(squares) <= HEIGHT_SPREAD * mean ? mean : 0;
}

static bool lies_in(const double plane[4], double tolerance, const double at[3], const double normal[3])
{
    return fabs(plane_height(plane, at)) <= tolerance && orl_dot3(normal, plane) > ALIGNED_COSINE;
}

// Share of the points that support the plane as ground; negative: they contradict it.
static double score(const struct sample *s, const double plane[4], double height)
{
    double tolerance = s->tolerance, mean[3] = {0}, squares = 0;
    double counted = 0;
    int on = 0, beneath = 0;
    for (int i = 0; i < s->count; i++) {
        const double *at = s->position[i];
        double off = plane_height(plane, at);
        beneath += off < -BENEATH * tolerance;
        if (!lies_in(plane, tolerance, at, s->normal[i]))
            continue;
        counted += 1 - off * off / (tolerance * tolerance);
        on++;
        squares += orl_dot3(at, at);
        for (int k = 0; k < 3; k++)
            mean[k] += at[k];
    }
    double extent2 = on ? squares / on - orl_dot3(mean, mean) / ((double)on * on) : 0;
    if (beneath > BENEATH_MAX * s->count || extent2 < EXTENT * EXTENT * height * height)
        return -1;
    return (counted - beneath) / s->count;
}

// The first point from `start` on that faces nearly as point i does.
static const double *other_point(const struct sample *s, int i, int start)
{
    int k = start % s->count, end = k;
    do {
        if (orl_dot3(s->normal[i], s->normal[k]) > ALIGNED_COSINE)
            return s->position[k];
        k = (k + 1) % s->count;
    } while (k != end);
    return s->position[i];
}

// A plane through point i: its own, or that of two others, too, since a point's normal is off by degrees.
static bool candidate(const struct sample *s, int i, int try, double plane[4])
{
    const double *at = s->position[i];
    const double *a = other_point(s, i, i + STEP * (2 * try + 1)), *b = other_point(s, i, i + STEP * (2 * try + 2));
    const double to_a[3] = {a[0] - at[0], a[1] - at[1], a[2] - at[2]};
    const double to_b[3] = {b[0] - at[0], b[1] - at[1], b[2] - at[2]};
    if (try == 0)
        memcpy(plane, s->normal[i], sizeof s->normal[i]);
    else
        orl_cross3(to_a, to_b, plane);
    double length = orl_normalize3(plane);
    plane[3] = -orl_dot3(plane, at);
    return length > 0 && isfinite(length);
}

// Moves the plane to the weighted least squares of all points that lie in it: its normal becomes the direction in
// which they vary least, by a step of inverse iteration. False when the points determine no plane.
static bool fit(const struct sample *s, const struct orl_points *points, double plane[4])
{
    const double *eye = s->centres[0]; // near the points, however far the origin is
    double variance[9] = {0}, mean[3] = {0}, total = 0;
    for (size_t i = 0; i < points->count; i++) {
        double at[3], normal[3], from_eye[3];
        for (int k = 0; k < 3; k++) {
            at[k] = (double)points->position[i][k];
            normal[k] = (double)points->normal[i][k];
            from_eye[k] = at[k] - eye[k];
        }
        if (!lies_in(plane, s->tolerance, at, normal))
            continue;
        double weight = seen_size(s, points, i);
        total += weight;
        for (int k = 0; k < 3; k++)
            mean[k] += weight * from_eye[k];
        for (int k = 0; k < 9; k++)
            variance[k] += weight * from_eye[k / 3] * from_eye[k % 3];
    }
    for (int k = 0; k < 9; k++)
        variance[k] -= mean[k / 3] * mean[k % 3] / total;
    if (!orl_cholesky_solve(variance, plane, 3))
        return false;
    orl_normalize3(plane);
    plane[3] = -orl_dot3(plane, mean) / total - orl_dot3(plane, eye);
    return true;
}

// Fits the plane to all points that lie in it, and takes the result unless that is no ground. The plane that was found
// goes through three points, which are as noisy as stereo is; a height that is wrong by a twentieth costs up to half a
// decibel.
static void keep_fitted(const struct sample *s, const struct orl_points *points, struct orl_ground *ground)
{
    double plane[4];
    memcpy(plane, ground->plane, sizeof plane);
    for (int i = 0; i < FITS; i++)
        if (!fit(s, points, plane))
            return;
    double height = stood_height(s, plane);
    if (!(height > 0 && score(s, plane, height) > SCORE_MIN))
        return;
    ground->height = height;
    memcpy(ground->plane, plane, sizeof plane);
}

enum orl_result orl_ground_find(const struct orl_log *log, const struct orl_scene *scene,
                                struct orl_ground *ground)
{
    *ground = (struct orl_ground){.known = true};
    struct sample s = {0};
    enum orl_result result = take_sample(log, scene, &s);
    if (result != ORL_OK || s.photo_count < 3)
        goto finish;
    double best = SCORE_MIN;
    for (int t = 0; t < TRIES * s.count; t++) {
        double plane[4], height;
        if (!candidate(&s, t / TRIES, t % TRIES, plane) || (height = stood_height(&s, plane)) == 0)
            continue;
        double here = score(&s, plane, height);
        if (!(here > best)) // true also for NaN
            continue;
        best = here;
        ground->height = height;
        for (int k = 0; k < 4; k++)
            ground->plane[k] = plane[k];
    }
    if (ground->height > 0)
        keep_fitted(&s, &scene->points, ground);
finish:
    free(s.position);
    free(s.normal);
    return result;
}

bool orl_ground_along_rays(const struct orl_ground *ground, const struct orl_view *view,
                           double inverse[3])
{
    const struct orl_pose *pose = &view->cam_from_world;
    double eye[3];
    orl_pose_centre(pose, eye);
    double height = plane_height(ground->plane, eye);
    if (!(ground->height > 0 && height > 0))
        return false;
    for (int k = 0; k < 3; k++)
        inverse[k] = -orl_dot3(pose->r[k], ground->plane) / height;
    return true;
}
