// The room that a scene's subject is in.
#ifndef ORL_SCENE_ROOM_EXTENT_H
#define ORL_SCENE_ROOM_EXTENT_H

#include "oriel/scene.h"

// Middle and half sides of the scene's room, world. Where it is not known, of a shell: its middle is that
// of the box from `low` to `high`, and its radius, twice the distance of the farthest photograph, is
// given thrice.
void orl_room_measure(const struct orl_scene *scene, const double low[3], const double high[3],
                      double middle[3], double half[3]);

#endif
