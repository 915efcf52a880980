// Calibrate: camera positions and intrinsics, by COLMAP's structure from motion.
#ifndef ORL_PREPROCESS_CALIBRATE_H
#define ORL_PREPROCESS_CALIBRATE_H

#include "preprocess/job/job.h"

// Leaves .oriel/calibrate/model, of the photographs that could be placed. Of `record`, here
// and in the other stages: what is worth keeping, such as settings as used, and counts.
enum orl_result orl_stage_calibrate(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
// Makes the folder of the calibration ready for jobs (parts.h), which keep what they have done.
enum orl_result orl_calibrate_begin(struct orl_job *job) ORL_CHECK_RESULT;

#endif
