// The light that a scene is shown in: the exposure and white balance of one of its photographs.
#ifndef ORL_SCENE_LIGHT_H
#define ORL_SCENE_LIGHT_H

#include "oriel/scene.h"

// Makes gains relative to the photograph of this name (with or without extension), so that aligned
// photographs appear in its exposure and white balance and it keeps its own colours. Call before a
// renderer is created. NULL: the light stays. ORL_ERR_ARGUMENT: there is no such photograph, or it
// is held out, so that its pixels are not known.
enum orl_result orl_scene_set_light(const struct orl_log *log, struct orl_scene *scene,
                                    const char *photo) ORL_CHECK_RESULT;

#endif
