// What gets worse about cameras, and about where the viewer stands.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/vec3.h"
#include "eval/stress_internal.h"

enum { PHOTOS_LEFT = 3, PHOTOS_FOR_A_VIEW = 2, POSE_SAMPLES = 400 };
static const double degree = 0.017453292519943295;

// Leaves out `level` percent of the photographs, evenly, but for three.
enum orl_result orl_stress_fewer_photos(struct stress_case *c, double level, uint64_t seed)
{
    (void)seed;
    size_t all = 0, at = 0;
    for (size_t i = 0; i < c->scene.photo_count; i++)
        all += !c->scene.photos[i].test;
    size_t kept = (size_t)lround((double)all * (1 - level / 100));
    kept = kept < PHOTOS_LEFT ? PHOTOS_LEFT : kept;
    if (kept > all)
        return ORL_ERR_NOT_FOUND;
    for (size_t i = 0; i < c->scene.photo_count; i++) {
        if (c->scene.photos[i].test)
            continue;
        bool stays = (at + 1) * kept / all > at * kept / all;
        c->scene.photos[i].test = !stays;
        at++;
    }
    return ORL_OK;
}

// --- calibration ---

struct pose_error {
    double turn[3], shift[3]; // rotation vector; translation in scene units
};

static struct orl_pose wrong_pose(const struct orl_pose *pose, const struct pose_error *error,
                                  double scale)
{
    double axis[3], r[3][3], angle = 0;
    for (int k = 0; k < 3; k++)
        axis[k] = scale * error->turn[k];
    angle = orl_normalize3(axis);
    double s = sin(angle), q = 1 - cos(angle);
    for (int i = 0; i < 3; i++) // Rodrigues' formula
        for (int j = 0; j < 3; j++) {
            double cross = i == j ? 0 : ((j - i + 3) % 3 == 1 ? -1 : 1) * axis[3 - i - j];
            r[i][j] = (i == j ? 1 - q : 0) + q * axis[i] * axis[j] + s * cross;
        }
    struct orl_pose wrong;
    for (int i = 0; i < 3; i++) {
        wrong.t[i] = scale * error->shift[i];
        for (int j = 0; j < 3; j++) {
            wrong.t[i] += r[i][j] * pose->t[j];
            wrong.r[i][j] = 0;
            for (int k = 0; k < 3; k++)
                wrong.r[i][j] += r[i][k] * pose->r[k][j];
        }
    }
    return wrong;
}

// Root mean square shift of the points in the photograph, pixels.
static double reprojection(const struct stress_case *c, const struct orl_view *right,
                           const struct orl_view *wrong)
{
    const struct orl_points *points = &c->scene.points;
    size_t step = points->count / POSE_SAMPLES + 1;
    double sum = 0, count = 0;
    for (size_t i = 0; i < points->count; i += step) {
        double world[3], a[2], b[2], z;
        for (int k = 0; k < 3; k++)
            world[k] = (double)points->position[i][k];
        if (!orl_view_project(right, world, a, &z) || !orl_view_project(wrong, world, b, &z) ||
            a[0] < 0 || a[1] < 0 || a[0] > right->camera.width || a[1] > right->camera.height)
            continue;
        sum += (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
        count++;
    }
    return count > 0 ? sqrt(sum / count) : 0;
}

// Turns and shifts each camera at random, scaled to `level` pixels of reprojection error.
enum orl_result orl_stress_pose(struct stress_case *c, double level, uint64_t seed)
{
    for (size_t i = 0; i < c->scene.photo_count; i++) {
        struct orl_view *view = &c->scene.photos[i].view, wrong = *view;
        struct pose_error error;
        if (c->scene.photos[i].test)
            continue;
        for (uint64_t k = 0; k < 3; k++) {
            error.turn[k] = orl_stress_normal(seed, i, k) / view->camera.fx;
            error.shift[k] =
                orl_stress_normal(seed, i, 3 + k) / view->camera.fx * c->scene.photo_distance;
        }
        double scale = level;
        for (int round = 0; round < 3; round++) { // the error is nearly linear in its scale
            wrong.cam_from_world = wrong_pose(&view->cam_from_world, &error, scale);
            double found = reprojection(c, view, &wrong);
            scale *= found > 0 ? level / found : 1;
        }
        view->cam_from_world = wrong_pose(&view->cam_from_world, &error, scale);
    }
    return ORL_OK;
}

// Makes each focal length `level` percent too long or too short.
enum orl_result orl_stress_focal(struct stress_case *c, double level, uint64_t seed)
{
    for (size_t i = 0; i < c->scene.photo_count; i++) {
        struct orl_camera *camera = &c->scene.photos[i].view.camera;
        double sign = orl_stress_uniform(seed, i, 0) < 0.5 ? -1 : 1;
        if (c->scene.photos[i].test)
            continue;
        camera->fx *= 1 + sign * level / 100;
        camera->fy *= 1 + sign * level / 100;
    }
    return ORL_OK;
}

// --- the viewer ---

// What the view looks at: the point on its axis at the scene's distance.
static void target_of(const struct stress_case *c, const struct orl_view *view, double target[3])
{
    orl_view_unproject(view, view->camera.cx, view->camera.cy, c->scene.photo_distance, target);
}

static double angle_between(const double target[3], const struct orl_view *a,
                            const struct orl_view *b)
{
    double u[3], v[3];
    orl_pose_centre(&a->cam_from_world, u);
    orl_pose_centre(&b->cam_from_world, v);
    for (int k = 0; k < 3; k++) {
        u[k] -= target[k];
        v[k] -= target[k];
    }
    orl_normalize3(u);
    orl_normalize3(v);
    return acos(fmax(-1, fmin(1, orl_dot3(u, v))));
}

static enum orl_result leave_out_near(struct stress_case *c, struct stress_view *view, double least)
{
    size_t left = 0;
    double target[3];
    target_of(c, &view->view, target);
    enum orl_result result = orl_stress_own_scene(c, view);
    for (size_t i = 0; result == ORL_OK && i < c->scene.photo_count; i++) {
        struct orl_photo *photo = &view->scene->photos[i];
        photo->test = photo->test || angle_between(target, &view->view, &photo->view) < least;
        left += !photo->test;
    }
    if (result == ORL_OK && left < PHOTOS_FOR_A_VIEW)
        return ORL_ERR_NOT_FOUND;
    return result == ORL_OK
               ? orl_stress_color_points(orl_gpu_log(c->gpu), c->photos, view->scene)
               : result;
}

// Leaves out the photographs that see a view's target from directions within `level` degrees.
enum orl_result orl_stress_angle(struct stress_case *c, double level, uint64_t seed)
{
    (void)seed;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < c->view_count; i++)
        result = leave_out_near(c, &c->views[i], level * degree);
    for (size_t i = 0; result == ORL_OK && i < c->walk_count; i++)
        result = leave_out_near(c, &c->walk[i], level * degree);
    return result;
}

// Moves the viewer towards or away from the target. `zoom` keeps the framing: the focal length grows
// with the distance.
static enum orl_result move_views(struct stress_case *c, double factor, bool zoom)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < c->view_count + c->walk_count; i++) {
        bool walk = i >= c->view_count;
        struct stress_view *view = walk ? &c->walk[i - c->view_count] : &c->views[i];
        struct orl_pose *pose = &view->view.cam_from_world;
        const double *up = c->scene.ground.plane;
        double target[3], eye[3], way[3];
        if (factor == 1)
            break;
        target_of(c, &view->view, target);
        orl_pose_centre(pose, eye);
        for (int k = 0; k < 3; k++)
            way[k] = (factor - 1) * (eye[k] - target[k]);
        double rise = orl_dot3(way, up); // the viewer stays on the ground
        for (int k = 0; k < 3; k++)
            eye[k] += way[k] - rise * up[k];
        *pose = orl_pose_look_at(eye, target, up);
        if (zoom) {
            view->view.camera.fx *= factor;
            view->view.camera.fy *= factor;
        }
        result = orl_stress_draw_truth(c, &view->view, walk ? NULL : &view->picture,
                                       &view->depth);
    }
    return result;
}

// Brings the viewer to `level` times the distance from what the view looks at.
enum orl_result orl_stress_nearer(struct stress_case *c, double level, uint64_t seed)
{
    (void)seed;
    return move_views(c, level, false);
}

// The same with the framing kept, since what lies around was never photographed.
enum orl_result orl_stress_farther(struct stress_case *c, double level, uint64_t seed)
{
    (void)seed;
    return move_views(c, level, true);
}
