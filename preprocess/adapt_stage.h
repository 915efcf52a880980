// Adapt: how the scene is drawn best, by its training photographs (eval/adapt.h).
#ifndef ORL_PREPROCESS_ADAPT_STAGE_H
#define ORL_PREPROCESS_ADAPT_STAGE_H

#include "preprocess/job/job.h"

json_t *orl_stage_adapt_settings(const struct orl_job *job);
// Sets "tuned" and "render" of scene.json in `record`, and what they gain. A scene with too few
// training photographs keeps the usual method.
enum orl_result orl_stage_adapt(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
