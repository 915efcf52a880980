// Radii: turns the fused cloud into points.ply, with a radius and a normal for each point, or into
// points.lod where it is larger than memory.
#ifndef ORL_PREPROCESS_RADII_H
#define ORL_PREPROCESS_RADII_H

#include "preprocess/job/job.h"

// What the radii depend on besides the cloud: a new object.
json_t *orl_stage_radii_settings(const struct orl_job *job);

// Writes SCENE/points.ply or SCENE/points.lod, and removes the other.
enum orl_result orl_stage_radii(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
