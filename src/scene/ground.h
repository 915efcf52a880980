// The ground that the photographer stood on.
#ifndef ORL_SCENE_GROUND_H
#define ORL_SCENE_GROUND_H

#include "scene/scene.h"

// Looks for a plane that the training photographs, evenly at most 64 of them, were taken from at
// about one height above, along their horizontal, with hardly a point beneath and some on it; few
// will do, since ground is seen at a flat angle and hard to match. Held-out photographs take no
// part. The same scene gives the same ground. ground->height is 0 where there is none.
enum orl_result orl_ground_find(const struct orl_log *log, const struct orl_scene *scene,
                                struct orl_ground *ground) ORL_CHECK_RESULT;

#endif
