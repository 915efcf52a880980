// What suits the scene: settings of its method, and whether its backdrop rests.
#ifndef ORL_PREPROCESS_TUNE_STAGE_H
#define ORL_PREPROCESS_TUNE_STAGE_H

#include "preprocess/job/job.h"

// Renders some training photographs, each from the others, and sets in `record` what brings them closer: "tuned", the
// settings of the scene's method as orl_search_record has them, and "backdrop" (orl_manifest_backdrop). Held-out
// photographs take no part. Without a device, or with fewer than five photographs, "tuned" is empty and the backdrop moves.
enum orl_result orl_stage_tune(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
