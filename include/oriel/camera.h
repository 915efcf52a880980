// Cameras and poses. Conventions are COLMAP's: x right, y down, z forward;
// pixel centres at +0.5; a point's depth is its z in camera space.
#ifndef ORIEL_CAMERA_H
#define ORIEL_CAMERA_H

#include "oriel/common.h"

// Pinhole camera without distortion: u = fx x/z + cx, v = fy y/z + cy, in pixels.
struct orl_camera {
    int width, height;
    double fx, fy, cx, cy;
};

// cam_from_world: x_cam = r x_world + t. r is row-major: r[row][column].
struct orl_pose {
    double r[3][3], t[3];
};

struct orl_view {
    struct orl_camera camera;
    struct orl_pose cam_from_world;
};

// Largest accepted distance from the origin, in scene units. No real scene is larger, and the
// squares of such distances fit a float.
#define ORL_WORLD_MAX 1e18

// Checks that the size is at most ORL_IMAGE_MAX_SIDE, that focal lengths lie between a thousandth
// of the larger side (a field of view of almost 180 degrees) and a hundred thousand times that
// side, and that the principal point lies within ten image sizes of the centre.
bool orl_camera_valid(const struct orl_camera *camera);
// Checks that r is a rotation (no mirror, no scale) and that the centre is within ORL_WORLD_MAX.
bool orl_pose_valid(const struct orl_pose *pose);
// Why a view is not valid, in words; NULL: it is valid.
const char *orl_view_problem(const struct orl_view *view);
// The same camera for a picture of another size. Each axis is scaled separately.
struct orl_camera orl_camera_resized(const struct orl_camera *camera, int width, int height);

// Makes a pose from a quaternion w x y z, which is normalised here, and a translation. False when
// the quaternion is zero, a value is not finite or t is beyond ORL_WORLD_MAX.
bool orl_pose_from_quat(const double quat_wxyz[3 + 1], const double t[3], struct orl_pose *pose);
// Makes a pose from a world_from_cam rotation, whose columns are the camera's axes, and the camera
// centre. False when the pose is not valid.
bool orl_pose_from_axes(double world_from_cam[3][3], const double centre[3],
                        struct orl_pose *pose);
// Makes a pose from a row-major world_from_cam matrix of a camera with OpenGL's axes (y up, z
// backward).
bool orl_pose_from_opengl(const double world_from_cam[16], struct orl_pose *pose);
// Of the two quaternions of a rotation, gives the one with w >= 0.
void orl_pose_to_quat(const struct orl_pose *pose, double quat_wxyz[3 + 1]);
// The same camera in a world whose origin is at `origin` of the pose's world.
void orl_pose_move(struct orl_pose *pose, const double origin[3]);
// Camera centre in world space: -r^T t.
void orl_pose_centre(const struct orl_pose *pose, double centre[3]);
// Moves the camera there; it looks the same way.
void orl_pose_set_centre(struct orl_pose *pose, const double centre[3]);
// Camera at `eye` looking at `target`, image y along -up.
struct orl_pose orl_pose_look_at(const double eye[3], const double target[3], const double up[3]);
void orl_pose_apply(const struct orl_pose *cam_from_world, const double world[3], double cam[3]);
// A view between a (t = 0) and b (t = 1). Centres are interpolated linearly, rotations by slerp,
// focal lengths geometrically; the picture size is that of a.
struct orl_view orl_view_interpolate(const struct orl_view *a, const struct orl_view *b, double t);
// Projects a point. False when it lies behind the camera. Pixel coordinates may lie outside the
// picture.
bool orl_view_project(const struct orl_view *view, const double world[3], double pixel[2],
                      double *depth);
// The inverse of orl_view_project: the point with depth `depth` at pixel coordinates u, v.
void orl_view_unproject(const struct orl_view *view, double u, double v, double depth,
                        double world[3]);

// The least-squares problem whose solution is the point nearest to several rays. The caller zeroes
// it before the first ray.
struct orl_ray_meeting {
    double a[3][3], b[3];
};
// Adds a ray from `eye` in the direction `ray`, which may have any length above 0.
void orl_ray_meeting_add(struct orl_ray_meeting *meeting, const double eye[3],
                         const double ray[3]);
// False when the rays are too nearly parallel to define a point.
bool orl_ray_meeting_point(const struct orl_ray_meeting *meeting, double point[3]);

#endif
