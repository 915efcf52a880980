// Radii: the fused cloud becomes points.ply, with a radius and a normal for each.
#ifndef ORL_PREPROCESS_RADII_H
#define ORL_PREPROCESS_RADII_H

#include "preprocess/job/job.h"

// Leaves SCENE/points.ply.
enum orl_result orl_stage_radii(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
