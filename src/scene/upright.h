// Which way photographs, and a scene, are upright, what they look at, and the room that they are in.
#ifndef ORL_SCENE_UPRIGHT_H
#define ORL_SCENE_UPRIGHT_H

#include "oriel/scene.h"

// The photograph's view, turned by quarters about its axis so that it is upright as the orientation
// says; the same pixels, none mirrored.
struct orl_view orl_photo_upright(const struct orl_photo *photo);
// The mean upward direction of the upright photographs, world. False, and 0 -1 0, where they cancel
// each other.
bool orl_scene_mean_up(const struct orl_scene *scene, double up[3]);
// The place nearest to the optical axes of all photographs, world. False: they are parallel.
bool orl_scene_middle(const struct orl_scene *scene, double middle[3]);

// Middle and half sides of the scene's room, world. Where it is not known, of a shell: its middle is that
// of the box from `low` to `high`, and its radius, twice the distance of the farthest photograph that is
// not held out, is given thrice.
void orl_room_measure(const struct orl_scene *scene, const double low[3], const double high[3],
                      double middle[3], double half[3]);

#endif
