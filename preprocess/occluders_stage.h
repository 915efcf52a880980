// Occluders: what photographs show before the scene and has no points (eval/occluder_masks.h).
#ifndef ORL_PREPROCESS_OCCLUDERS_STAGE_H
#define ORL_PREPROCESS_OCCLUDERS_STAGE_H

#include "preprocess/job/job.h"

// Writes SCENE/occluders/NAME.png of each training photograph that shows any, and sets "occluded" in
// `record`: the share of the picture by name. Without a device, or with too few photographs, none
// are found.
enum orl_result orl_stage_occluders(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
