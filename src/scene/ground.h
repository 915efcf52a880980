// The ground that the photographer stood on.
#ifndef ORL_SCENE_GROUND_H
#define ORL_SCENE_GROUND_H

#include "scene/scene.h"

// Looks for a plane that most training photographs were taken from at about one height above, along
// their horizontal, with nothing beneath and some points on it; few will do, since ground is seen
// at a flat angle and hard to match. Held-out photographs take no part. The same scene gives
// the same ground. ground->height is 0 where there is none.
enum orl_result orl_ground_find(const struct orl_log *log, const struct orl_scene *scene,
                                struct orl_ground *ground) ORL_CHECK_RESULT;

#endif
