// Cameras and poses. Conventions are COLMAP's: x right, y down, z forward;
// pixel centres at +0.5; a point's depth is its z in camera space.
#ifndef ORIEL_CAMERA_H
#define ORIEL_CAMERA_H

#include "oriel/common.h"

// Pinhole without distortion. u = fx x/z + cx, v = fy y/z + cy, in pixels.
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

// Nothing real is farther from the origin, in any unit; squares of distances still fit a float.
#define ORL_WORLD_MAX 1e18

// A size up to ORL_IMAGE_MAX_SIDE, focal lengths from a thousandth of its larger side (a view of
// almost 180 degrees) to a hundred thousand times that, principal point within ten image sizes of
// the centre.
bool orl_camera_valid(const struct orl_camera *camera);
// A rotation (no mirror, no scale) and a centre within ORL_WORLD_MAX.
bool orl_pose_valid(const struct orl_pose *pose);
// What keeps a view from being one, in words; NULL: nothing.
const char *orl_view_problem(const struct orl_view *view);
// The same camera for a picture of another size: each axis scaled by itself.
struct orl_camera orl_camera_resized(const struct orl_camera *camera, int width, int height);

// From a quaternion w x y z (normalised here) and translation. False when the
// quaternion is zero, anything is not finite or t is beyond ORL_WORLD_MAX.
bool orl_pose_from_quat(const double quat_wxyz[3 + 1], const double t[3], struct orl_pose *pose);
// From a world_from_cam rotation, whose columns are the camera's axes, and its centre. False when
// they are no pose.
bool orl_pose_from_axes(double world_from_cam[3][3], const double centre[3],
                        struct orl_pose *pose);
// From a world_from_cam matrix, row by row, of a camera with OpenGL's axes (y up, z backward).
bool orl_pose_from_opengl(const double world_from_cam[16], struct orl_pose *pose);
// w >= 0.
void orl_pose_to_quat(const struct orl_pose *pose, double quat_wxyz[3 + 1]);
// Camera centre in world space: -r^T t.
void orl_pose_centre(const struct orl_pose *pose, double centre[3]);
// Camera at `eye` looking at `target`, image y along -up.
struct orl_pose orl_pose_look_at(const double eye[3], const double target[3], const double up[3]);
void orl_pose_apply(const struct orl_pose *cam_from_world, const double world[3], double cam[3]);
// Between a (t = 0) and b (t = 1): centres linearly, rotations by slerp, focal
// lengths geometrically; picture size of a.
struct orl_view orl_view_interpolate(const struct orl_view *a, const struct orl_view *b, double t);
// False behind the camera. Pixel coordinates may lie outside the picture.
bool orl_view_project(const struct orl_view *view, const double world[3], double pixel[2],
                      double *depth);
// Its inverse: what lies at `depth` along the camera's z axis behind pixel coordinates u, v.
void orl_view_unproject(const struct orl_view *view, double u, double v, double depth,
                        double world[3]);

// The point nearest to several rays, by least squares. Zeroed before the first ray.
struct orl_ray_meeting {
    double a[3][3], b[3];
};
// From `eye` in the direction of `ray`, of any length above 0.
void orl_ray_meeting_add(struct orl_ray_meeting *meeting, const double eye[3],
                         const double ray[3]);
// False when the rays are too parallel to say.
bool orl_ray_meeting_point(const struct orl_ray_meeting *meeting, double point[3]);

#endif
