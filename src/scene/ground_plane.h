// The ground that the photographer stood on.
#ifndef ORL_SCENE_GROUND_PLANE_H
#define ORL_SCENE_GROUND_PLANE_H

#include "core/vec3.h"
#include "oriel/scene.h"

// Looks for a plane that the training photographs, evenly at most 64 of them, were taken from at
// about one height above, along their horizontal, with hardly a point beneath and some on it; few
// will do, since ground is seen at a flat angle and hard to match. Held-out photographs take no
// part. The same scene gives the same ground. ground->height is 0 where there is none.
enum orl_result orl_ground_find(const struct orl_log *log, const struct orl_scene *scene,
                                struct orl_ground *ground) ORL_CHECK_RESULT;

// Of a point above the plane of struct orl_ground, in scene units; below: negative.
static inline double orl_plane_height(const double plane[4], const double at[3])
{
    return orl_dot3(plane, at) + plane[3];
}
// Where a view's rays meet it: the inverse of depth, z in the camera's frame, is the dot product of
// `inverse` and the ray (x/z, y/z, 1); not positive: the ray does not. False when there is no
// ground or the view is not above it.
bool orl_ground_along_rays(const struct orl_ground *ground, const struct orl_view *view,
                           double inverse[3]);

#endif
