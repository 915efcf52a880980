// The camera of the undistorted pictures.
#include <math.h>

#include "preprocess/import/import_internal.h"
#include "scene/colmap_internal.h"

static bool in_picture(const struct orl_colmap_camera *camera, const double ray[2])
{
    double pixel[2];
    orl_colmap_camera_project(camera, ray, pixel);
    // Up to half a pixel of the border may be repeated: the position lies within the picture.
    return pixel[0] >= 0 && pixel[1] >= 0 && pixel[0] <= camera->pinhole.width &&
           pixel[1] <= camera->pinhole.height;
}

// The greatest tangent along one direction from the axis for which pixels move outward and stay in
// the picture.
static double reach(const struct orl_colmap_camera *camera, const double direction[2])
{
    // COLMAP enlarges a picture to twice its size at most.
    const struct orl_camera *c = &camera->pinhole;
    double room = fabs(direction[0]) * (direction[0] < 0 ? c->cx : c->width - c->cx) / c->fx +
                  fabs(direction[1]) * (direction[1] < 0 ? c->cy : c->height - c->cy) / c->fy;
    double last = -INFINITY, at = 0, step = fmax(room, 1e-6) / 500;
    while (at < 2 * room) {
        double next = at + step, pixel[2];
        orl_colmap_camera_project(camera, (double[2]){next * direction[0], next * direction[1]},
                                  pixel);
        double along = pixel[0] * direction[0] + pixel[1] * direction[1];
        if (!(along > last) || pixel[0] < 0 || pixel[1] < 0 || pixel[0] > c->width ||
            pixel[1] > c->height)
            break;
        last = along;
        at = next;
    }
    return at;
}

// True when the distorted picture covers the rectangle's whole border. side: tangents of the angles
// from the axis to its left, top, right and bottom side.
static bool covered(const struct orl_colmap_camera *camera, const double side[4])
{
    enum { SAMPLES = 64 };
    for (int i = 0; i <= SAMPLES; i++) {
        double t = (double)i / SAMPLES;
        double x = -side[0] + t * (side[0] + side[2]);
        double y = -side[1] + t * (side[1] + side[3]);
        const double border[4][2] = {
            {x, -side[1]}, {x, side[3]}, {-side[0], y}, {side[2], y}};
        for (int k = 0; k < 4; k++)
            if (!in_picture(camera, border[k]))
                return false;
    }
    return true;
}

bool orl_import_is_same(const struct orl_colmap_camera *from, const struct orl_camera *to)
{
    return orl_colmap_camera_is_pinhole(from) && from->pinhole.width == to->width &&
           from->pinhole.height == to->height;
}

// Of what distortion leaves of a picture, one side may be a few pixels.
static int scaled_side(int side, int most, int larger)
{
    return (int)fmax(1, rint((double)side * most / larger));
}

struct orl_camera orl_import_target(const struct orl_colmap_camera *from, int max_size)
{
    static const double directions[4][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};
    const double shrink = 0.995, least = 0.2; // COLMAP's smallest scale
    struct orl_camera to = from->pinhole;
    double side[4]; // see covered
    bool distorted = !orl_colmap_camera_is_pinhole(from);
    for (int k = 0; k < 4; k++)
        side[k] = reach(from, directions[k]);
    for (double scale = 1; distorted && scale > least && !covered(from, side); scale *= shrink)
        for (int k = 0; k < 4; k++)
            side[k] *= shrink;
    if (distorted) {
        to.width = (int)fmax(1, floor((side[0] + side[2]) * to.fx));
        to.height = (int)fmax(1, floor((side[1] + side[3]) * to.fy));
        to.cx = side[0] * to.fx;
        to.cy = side[1] * to.fy;
    }
    int larger = to.width > to.height ? to.width : to.height;
    if (max_size && larger > max_size)
        to = orl_camera_resized(&to, scaled_side(to.width, max_size, larger),
                                scaled_side(to.height, max_size, larger));
    return to;
}
