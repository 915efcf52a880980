// Radii: turns the fused cloud into points.ply, with a radius and a normal for each point.
#ifndef ORL_PREPROCESS_RADII_H
#define ORL_PREPROCESS_RADII_H

#include "preprocess/job/job.h"

// Writes SCENE/points.ply.
enum orl_result orl_stage_radii(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
