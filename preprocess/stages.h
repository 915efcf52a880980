// The stages of a job in order: their keys, their records, and running those that are to do.
#ifndef ORL_PREPROCESS_STAGES_H
#define ORL_PREPROCESS_STAGES_H

#include "preprocess/job/job.h"

// What earlier runs did, from .oriel/stages.json; nothing where there is none.
enum orl_result orl_stages_load(struct orl_job *job) ORL_CHECK_RESULT;
// Of what was collected: the key that each stage's result has with these inputs and settings.
// Notes the stage collect, which took `wall_s`, as done.
enum orl_result orl_stages_begin(struct orl_job *job, double wall_s) ORL_CHECK_RESULT;
// Runs the stages after collect whose key or result is not there. Before anything of a stage
// changes scene.json goes, and so do the records of all that builds on it.
enum orl_result orl_stages_run(struct orl_job *job) ORL_CHECK_RESULT;
// Runs densify and all that follows, of a folder whose undistorted photographs and sparse model
// did not come from the stages before.
enum orl_result orl_stages_run_points(struct orl_job *job) ORL_CHECK_RESULT;

#endif
