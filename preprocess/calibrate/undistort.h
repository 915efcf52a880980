// Undistort: pinhole photographs and the sparse model that belongs to them.
#ifndef ORL_PREPROCESS_UNDISTORT_H
#define ORL_PREPROCESS_UNDISTORT_H

#include "preprocess/job/job.h"

// Leaves SCENE/images and SCENE/sparse, and what travels with them (companions.h).
enum orl_result orl_stage_undistort(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
