#include "oriel/camera.h"

#include <math.h>
#include <string.h>

#include "oriel/image.h"
#include "core/vec3.h"

static bool focal_valid(double focal, double side)
{
    return focal >= 1e-3 * side && focal <= 1e5 * side; // false also for NaN
}

bool orl_camera_valid(const struct orl_camera *c)
{
    double side = fmax(c->width, c->height);
    return c->width > 0 && c->height > 0 && c->width <= ORL_IMAGE_MAX_SIDE &&
           c->height <= ORL_IMAGE_MAX_SIDE && focal_valid(c->fx, side) &&
           focal_valid(c->fy, side) && fabs(c->cx - 0.5 * c->width) <= 10.0 * c->width &&
           fabs(c->cy - 0.5 * c->height) <= 10.0 * c->height;
}

static bool within_world(const double v[3])
{
    return fabs(v[0]) <= ORL_WORLD_MAX && fabs(v[1]) <= ORL_WORLD_MAX &&
           fabs(v[2]) <= ORL_WORLD_MAX;
}

bool orl_pose_valid(const struct orl_pose *pose)
{
    double across[3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (!(fabs(orl_dot3(pose->r[i], pose->r[j]) - (i == j)) <= 1e-3))
                return false;
    orl_cross3(pose->r[0], pose->r[1], across);
    return orl_dot3(across, pose->r[2]) > 0 && within_world(pose->t);
}

const char *orl_view_problem(const struct orl_view *view)
{
    if (!orl_camera_valid(&view->camera))
        return "its size, focal length or principal point is absurd";
    if (!within_world(view->cam_from_world.t))
        return "its position is absurdly far";
    return orl_pose_valid(&view->cam_from_world) ? NULL : "its axes are no rotation, or a mirror's";
}

struct orl_camera orl_camera_resized(const struct orl_camera *camera, int width, int height)
{
    double sx = (double)width / camera->width, sy = (double)height / camera->height;
    return (struct orl_camera){.width = width, .height = height,
                               .fx = camera->fx * sx, .fy = camera->fy * sy,
                               .cx = camera->cx * sx, .cy = camera->cy * sy};
}

bool orl_pose_from_quat(const double quat_wxyz[4], const double t[3], struct orl_pose *pose)
{
    double w = quat_wxyz[0], x = quat_wxyz[1], y = quat_wxyz[2], z = quat_wxyz[3];
    double norm = sqrt(w * w + x * x + y * y + z * z);
    if (!isfinite(norm) || norm < 1e-12 || !within_world(t))
        return false;
    w /= norm, x /= norm, y /= norm, z /= norm;
    *pose = (struct orl_pose){
        .r = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
              {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
              {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}},
        .t = {t[0], t[1], t[2]}};
    return true;
}

bool orl_pose_from_axes(double world_from_cam[3][3], const double centre[3],
                        struct orl_pose *pose)
{
    for (int i = 0; i < 3; i++) {
        pose->t[i] = 0;
        for (int j = 0; j < 3; j++) {
            pose->r[i][j] = world_from_cam[j][i];
            pose->t[i] -= world_from_cam[j][i] * centre[j];
        }
    }
    return orl_pose_valid(pose);
}

bool orl_pose_from_opengl(const double m[16], struct orl_pose *pose)
{
    double axes[3][3], centre[3];
    for (int i = 0; i < 3; i++) {
        axes[i][0] = m[4 * i];
        axes[i][1] = -m[4 * i + 1];
        axes[i][2] = -m[4 * i + 2];
        centre[i] = m[4 * i + 3];
    }
    return orl_pose_from_axes(axes, centre, pose);
}

void orl_pose_move(struct orl_pose *pose, const double origin[3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            pose->t[i] += pose->r[i][j] * origin[j];
}

void orl_pose_to_quat(const struct orl_pose *pose, double q[4])
{
    // Shepperd's method: dividing by the largest component keeps accuracy.
    const double (*r)[3] = pose->r;
    double trace = r[0][0] + r[1][1] + r[2][2];
    double squares[4] = {trace, r[0][0], r[1][1], r[2][2]};
    int largest = 0;
    for (int i = 1; i < 4; i++)
        if (squares[i] > squares[largest])
            largest = i;
    double s = 2 * sqrt(fmax(1e-300, largest == 0 ? 1 + trace : 1 - trace + 2 * squares[largest]));
    if (largest == 0) {
        q[0] = s / 4, q[1] = (r[2][1] - r[1][2]) / s;
        q[2] = (r[0][2] - r[2][0]) / s, q[3] = (r[1][0] - r[0][1]) / s;
    } else {
        int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
        q[0] = (r[k][j] - r[j][k]) / s;
        q[1 + i] = s / 4;
        q[1 + j] = (r[j][i] + r[i][j]) / s;
        q[1 + k] = (r[k][i] + r[i][k]) / s;
    }
    if (q[0] < 0)
        for (int i = 0; i < 4; i++)
            q[i] = -q[i];
}

void orl_pose_centre(const struct orl_pose *pose, double centre[3])
{
    for (int i = 0; i < 3; i++)
        centre[i] = -(pose->r[0][i] * pose->t[0] + pose->r[1][i] * pose->t[1] +
                      pose->r[2][i] * pose->t[2]);
}

void orl_pose_set_centre(struct orl_pose *pose, const double centre[3])
{
    for (int i = 0; i < 3; i++)
        pose->t[i] = -orl_dot3(pose->r[i], centre);
}

struct orl_pose orl_pose_look_at(const double eye[3], const double target[3], const double up[3])
{
    struct orl_pose pose;
    double x[3], y[3], z[3] = {target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]};
    if (!(orl_normalize3(z) > 0))
        z[0] = 0, z[1] = 0, z[2] = 1;
    orl_cross3(z, up, x);
    if (!(orl_normalize3(x) > 0)) { // looking along `up`: any horizontal axis works
        const double other[3] = {fabs(z[0]) < 0.5, fabs(z[0]) >= 0.5, 0};
        orl_cross3(z, other, x);
        orl_normalize3(x);
    }
    orl_cross3(z, x, y);
    memcpy(pose.r[0], x, sizeof x);
    memcpy(pose.r[1], y, sizeof y);
    memcpy(pose.r[2], z, sizeof z);
    orl_pose_set_centre(&pose, eye);
    return pose;
}

void orl_pose_apply(const struct orl_pose *pose, const double world[3], double cam[3])
{
    for (int i = 0; i < 3; i++)
        cam[i] = orl_dot3(pose->r[i], world) + pose->t[i];
}

static void slerp(const double a[4], const double b[4], double t, double out[4])
{
    double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    double sign = cosine < 0 ? -1 : 1;
    double angle = acos(fmin(1, fabs(cosine)));
    bool tiny = angle < 1e-6;
    double wa = tiny ? 1 - t : sin((1 - t) * angle) / sin(angle);
    double wb = tiny ? t : sin(t * angle) / sin(angle);
    for (int i = 0; i < 4; i++)
        out[i] = wa * a[i] + sign * wb * b[i];
}

struct orl_view orl_view_interpolate(const struct orl_view *a, const struct orl_view *b, double t)
{
    struct orl_view view = {.camera = a->camera};
    struct orl_camera other = orl_camera_resized(&b->camera, a->camera.width, a->camera.height);
    view.camera.fx = a->camera.fx * pow(other.fx / a->camera.fx, t);
    view.camera.fy = a->camera.fy * pow(other.fy / a->camera.fy, t);
    view.camera.cx += t * (other.cx - a->camera.cx);
    view.camera.cy += t * (other.cy - a->camera.cy);
    double qa[4], qb[4], q[4], ca[3], cb[3], centre[3];
    const double zero[3] = {0, 0, 0};
    orl_pose_to_quat(&a->cam_from_world, qa);
    orl_pose_to_quat(&b->cam_from_world, qb);
    slerp(qa, qb, t, q);
    orl_pose_centre(&a->cam_from_world, ca);
    orl_pose_centre(&b->cam_from_world, cb);
    for (int i = 0; i < 3; i++)
        centre[i] = ca[i] + t * (cb[i] - ca[i]);
    orl_pose_from_quat(q, zero, &view.cam_from_world);
    orl_pose_set_centre(&view.cam_from_world, centre);
    return view;
}

bool orl_view_project(const struct orl_view *view, const double world[3], double pixel[2],
                      double *depth)
{
    double cam[3];
    orl_pose_apply(&view->cam_from_world, world, cam);
    *depth = cam[2];
    if (!(cam[2] > 0))
        return false;
    pixel[0] = view->camera.fx * cam[0] / cam[2] + view->camera.cx;
    pixel[1] = view->camera.fy * cam[1] / cam[2] + view->camera.cy;
    return true;
}

void orl_view_unproject(const struct orl_view *view, double u, double v, double depth,
                        double world[3])
{
    const struct orl_camera *c = &view->camera;
    const struct orl_pose *pose = &view->cam_from_world;
    double cam[3] = {(u - c->cx) / c->fx * depth, (v - c->cy) / c->fy * depth, depth};
    for (int k = 0; k < 3; k++) {
        world[k] = 0;
        for (int j = 0; j < 3; j++)
            world[k] += pose->r[j][k] * (cam[j] - pose->t[j]);
    }
}

void orl_ray_meeting_add(struct orl_ray_meeting *meeting, const double eye[3], const double ray[3])
{
    double d[3] = {ray[0], ray[1], ray[2]};
    orl_normalize3(d);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            double across = (r == c) - d[r] * d[c];
            meeting->a[r][c] += across;
            meeting->b[r] += across * eye[c];
        }
}

// Solves the 3x3 system by Cramer's rule.
bool orl_ray_meeting_point(const struct orl_ray_meeting *meeting, double point[3])
{
    const double (*a)[3] = meeting->a, *b = meeting->b;
    double rows[3][3], scale = a[0][0] + a[1][1] + a[2][2];
    for (int k = 0; k < 3; k++)
        orl_cross3(a[(k + 1) % 3], a[(k + 2) % 3], rows[k]);
    double det = orl_dot3(a[0], rows[0]);
    if (!(fabs(det) > 1e-9 * scale * scale * scale))
        return false;
    for (int i = 0; i < 3; i++)
        point[i] = (rows[0][i] * b[0] + rows[1][i] * b[1] + rows[2][i] * b[2]) / det;
    return true;
}
