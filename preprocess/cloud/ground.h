// Ground: the plane that photographs were taken from above.
#ifndef ORL_PREPROCESS_GROUND_H
#define ORL_PREPROCESS_GROUND_H

#include "preprocess/job/job.h"
#include "oriel/scene.h"

// Shifts and tilts scene->ground a little, so that training photographs agree better on what lies
// on it where they have no stereo depth; held-out photographs are not read. Left as it is
// where too little ground is in sight of two photographs, there are no depth maps, or there is no
// ground.
enum orl_result orl_ground_refine(const struct orl_log *log,
                                  struct orl_scene *scene) ORL_CHECK_RESULT;
// Looks for the ground among the points, refines it, and sets "ground" of `record`: null where
// there is none. Runs before the depth maps go.
enum orl_result orl_stage_ground(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
