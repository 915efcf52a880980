// Ground: the plane below the cameras.
#ifndef ORL_PREPROCESS_GROUND_H
#define ORL_PREPROCESS_GROUND_H

#include "preprocess/job/job.h"

// Sets "ground" of `record` to the plane that the points tell, so that no one who opens the scene need look
// for it; null when there is no ground.
enum orl_result orl_stage_ground(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
