// The device of stages that render training photographs from the others.
#ifndef ORL_PREPROCESS_DRAWING_H
#define ORL_PREPROCESS_DRAWING_H

#include "oriel/gpu.h"
#include "preprocess/job/job.h"

struct orl_drawing {
    struct orl_gpu *gpu; // that of the job, or `own`; NULL: the stage does without
    struct orl_gpu *own;
};

// Where no device can draw, or the scene has too few training photographs, which the log says with
// `without`, the stage's name and what it does then: COLMAP's stereo needs no device that draws, and
// a scene is whole without what such a stage finds.
void orl_drawing_begin(const struct orl_job *job, const struct orl_scene *scene,
                       const char *without, struct orl_drawing *drawing);
void orl_drawing_end(struct orl_drawing *drawing);

#endif
