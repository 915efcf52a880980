#include "scene/room_extent.h"

#include <math.h>

static const double SHELL = 2; // radius, in distances of the farthest photograph

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
        orl_pose_centre(&scene->photos[i].view.cam_from_world, eye);
        for (int k = 0; k < 3; k++)
            squares += (eye[k] - middle[k]) * (eye[k] - middle[k]);
        farthest = fmax(farthest, sqrt(squares));
    }
    for (int k = 0; !room->known && k < 3; k++)
        half[k] = farthest > 0 ? SHELL * farthest : 1;
}
