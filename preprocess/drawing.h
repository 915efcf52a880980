// The device of stages that render training photographs from the others.
#ifndef ORL_PREPROCESS_DRAWING_H
#define ORL_PREPROCESS_DRAWING_H

#include "preprocess/job/job.h"

// The job's device. NULL: the stage does without, since no device can draw or the scene has too few training
// photographs, which the log says with `without`, the stage's name and what it does then: COLMAP's stereo needs no
// device that draws, and a scene is whole without what such a stage finds.
struct orl_gpu *orl_drawing_device(struct orl_job *job, const struct orl_scene *scene, const char *without);

#endif
