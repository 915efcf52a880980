// What is in a scene, for programs and people.
#ifndef ORL_SCENE_INFO_H
#define ORL_SCENE_INFO_H

#include <jansson.h>

#include "oriel/scene.h"

// Bounds of the points, which must not be none.
void orl_points_bounds(const struct orl_points *points, double low[3], double high[3]);
// How many photographs have the camera of this one; 0: an earlier photograph has it, too.
size_t orl_scene_camera_users(const struct orl_scene *scene, size_t photo);
// docs/reference/files.md; new. NULL, logged: scene.json is damaged, or there is no memory.
json_t *orl_scene_info(const struct orl_log *log, const struct orl_scene *scene);

#endif
