// The scene's ground made exact by what photographs show on it.
#ifndef ORL_PREPROCESS_GROUND_H
#define ORL_PREPROCESS_GROUND_H

#include "scene/scene.h"

// Shifts and tilts scene->ground a little, so that training photographs agree better on what lies
// on it where they have no stereo depth; held-out photographs are not read. Left as it is
// where too little ground is in sight of two photographs, there are no depth maps, or there is no
// ground.
enum orl_result orl_ground_refine(const struct orl_log *log,
                                  struct orl_scene *scene) ORL_CHECK_RESULT;

#endif
