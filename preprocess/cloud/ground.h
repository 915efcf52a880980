// Ground: the plane below the cameras.
#ifndef ORL_PREPROCESS_GROUND_H
#define ORL_PREPROCESS_GROUND_H

#include "preprocess/job/job.h"
#include "oriel/scene.h"

// Shifts and tilts scene->ground slightly, so that training photographs agree better on the
// ground's texture where they have no stereo depth. Held-out photographs are not read. The ground
// stays unchanged when there is none, when there are no depth maps, or when two photographs see too
// little of it without stereo depth. Its height becomes 0, no plane, when photographs hardly show the
// plane that was found, with stereo depth or without.
enum orl_result orl_ground_refine(const struct orl_log *log,
                                  struct orl_scene *scene) ORL_CHECK_RESULT;
// Fits the ground to the points, refines it, and sets "ground" of `record`, null when there is no
// ground. Must run before the depth maps are deleted.
enum orl_result orl_stage_ground(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
