// The work that is left after collect or undistort as a graph of commands, for engines that run such graphs on
// several machines (docs/how/scale.md).
#ifndef ORL_PREPROCESS_PLAN_H
#define ORL_PREPROCESS_PLAN_H

#include <jansson.h>

#include "oriel/log.h"

// Plans SCENE, which `oriel prepare --until collect` or `undistort` has left, with at most `photographs` of them
// a job. *plan is released with json_decref; docs/reference/json.md says what is in it. A whole
// scene has no jobs. ORL_ERR_DATA: the folder is not that far.
enum orl_result orl_plan(const struct orl_log *log, const char *scene, int photographs,
                         json_t **plan) ORL_CHECK_RESULT;

#endif
