// A description of a scene for programs and people.
#ifndef ORL_SCENE_INFO_H
#define ORL_SCENE_INFO_H

#include <jansson.h>

#include "oriel/scene.h"

// Bounds of the points; 0 where there are none.
void orl_points_bounds(const struct orl_points *points, double low[3], double high[3]);
// Number of photographs that have one.
size_t orl_scene_silhouettes(const struct orl_scene *scene);
// Number of photographs that share this photograph's camera; 0 when an earlier photograph has the
// same camera, so that each camera is counted once.
size_t orl_scene_camera_users(const struct orl_scene *scene, size_t photo);
// The description as docs/reference/files.md defines it, released with json_decref. NULL, logged,
// when scene.json is damaged or memory runs out.
json_t *orl_scene_info(const struct orl_log *log, const struct orl_scene *scene);

#endif
