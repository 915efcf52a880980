// The stage densify of a job: depth maps by the built-in stereo (preprocess/densify, which works on
// any COLMAP workspace) or by COLMAP's stereo.
#ifndef ORL_PREPROCESS_DENSIFY_STAGE_H
#define ORL_PREPROCESS_DENSIFY_STAGE_H

#include "preprocess/job/job.h"

// Writes SCENE/stereo.
enum orl_result orl_stage_densify(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
