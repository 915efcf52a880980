#include "scene/upright.h"

#include <math.h>
#include <string.h>

#include "core/vec3.h"

struct orl_view orl_photo_upright(const struct orl_photo *photo)
{
    // Quarters, clockwise, that turn a picture of each EXIF orientation upright, mirrored ones too.
    static const int quarters[9] = {0, 0, 0, 2, 2, 1, 1, 3, 3};
    struct orl_view view = photo->view;
    bool known = photo->orientation >= 1 && photo->orientation <= 8;
    for (int i = known ? quarters[photo->orientation] : 0; i > 0; i--) {
        struct orl_view was = view;
        struct orl_camera *c = &view.camera;
        struct orl_pose *pose = &view.cam_from_world;
        for (int k = 0; k < 3; k++) { // upwards is to the right then, the right downwards
            pose->r[0][k] = -was.cam_from_world.r[1][k];
            pose->r[1][k] = was.cam_from_world.r[0][k];
        }
        pose->t[0] = -was.cam_from_world.t[1];
        pose->t[1] = was.cam_from_world.t[0];
        *c = (struct orl_camera){.width = was.camera.height, .height = was.camera.width,
                                 .fx = was.camera.fy, .fy = was.camera.fx,
                                 .cx = was.camera.height - was.camera.cy, .cy = was.camera.cx};
    }
    return view;
}

bool orl_scene_mean_up(const struct orl_scene *scene, double up[3])
{
    memset(up, 0, 3 * sizeof *up);
    for (size_t i = 0; i < scene->photo_count; i++) {
        struct orl_view view = orl_photo_upright(&scene->photos[i]);
        for (int k = 0; k < 3; k++)
            up[k] -= view.cam_from_world.r[1][k];
    }
    if (orl_normalize3(up) > 0)
        return true;
    up[0] = up[2] = 0;
    up[1] = -1;
    return false;
}

bool orl_scene_middle(const struct orl_scene *scene, double middle[3])
{
    struct orl_ray_meeting meeting = {0};
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_pose *pose = &scene->photos[i].view.cam_from_world;
        double eye[3];
        orl_pose_centre(pose, eye);
        orl_ray_meeting_add(&meeting, eye, pose->r[2]);
    }
    return orl_ray_meeting_point(&meeting, middle);
}

// --- the room ---

static const double SHELL = 2; // radius, in distances of the farthest photograph that is not held out

void orl_room_measure(const struct orl_scene *scene, const double low[3], const double high[3],
                      double middle[3], double half[3])
{
    const struct orl_room *room = &scene->room;
    double farthest = 0;
    low = room->known ? room->low : low;
    high = room->known ? room->high : high;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (low[k] + high[k]);
        half[k] = 0.5 * (high[k] - low[k]);
    }
    for (size_t i = 0; !room->known && i < scene->photo_count; i++) {
        double eye[3], squares = 0;
        if (scene->photos[i].test)
            continue;
        orl_pose_centre(&scene->photos[i].view.cam_from_world, eye);
        for (int k = 0; k < 3; k++)
            squares += (eye[k] - middle[k]) * (eye[k] - middle[k]);
        farthest = fmax(farthest, sqrt(squares));
    }
    for (int k = 0; !room->known && k < 3; k++)
        half[k] = farthest > 0 ? SHELL * farthest : 1;
}
