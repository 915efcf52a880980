// The ground plane that the photographer stood on.
#ifndef ORL_SCENE_GROUND_PLANE_H
#define ORL_SCENE_GROUND_PLANE_H

#include "oriel/scene.h"

// Searches for a plane with the training photographs at about one height above it and level to it,
// with hardly any points beneath and some points on it. Few points on it suffice, since ground is
// seen at a grazing angle and hard to match. At most 64 photographs, evenly chosen, are used;
// held-out photographs are excluded. The search is deterministic. ground->height is 0 when no plane
// is found.
enum orl_result orl_ground_find(const struct orl_log *log, const struct orl_scene *scene,
                                struct orl_ground *ground) ORL_CHECK_RESULT;

// Intersects a view's rays with the ground. The inverse of the depth (z in the camera's frame) is
// the dot product of `inverse` and the ray (x/z, y/z, 1); a ray misses the ground when that is not
// positive. False when there is no ground or the view is not above it.
bool orl_ground_along_rays(const struct orl_ground *ground, const struct orl_view *view,
                           double inverse[3]);

#endif
