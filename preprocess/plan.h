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

// Rows of a report, in `parts` jobs and one that joins them.
struct orl_plan_report {
    const char *kind;    // the command: "chart" or "stress"
    const char *out;     // the report's folder
    const json_t *options; // arguments of the command that decide which rows there are, and how they
                           // are measured: the parts and the whole have the same
    bool quick;            // one of them is --quick
    int parts;
};
// Adds these jobs to a plan; they need its job `finish`, where the scene is not whole.
// ORL_ERR_DATA: the plan ends with the calibration.
enum orl_result orl_plan_add_report(const struct orl_log *log, json_t *plan,
                                    const struct orl_plan_report *report) ORL_CHECK_RESULT;

#endif
