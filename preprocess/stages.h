// The stages of a job in order: their keys, their records, and running the outdated ones.
#ifndef ORL_PREPROCESS_STAGES_H
#define ORL_PREPROCESS_STAGES_H

#include "preprocess/job/job.h"

// Loads the records of earlier runs from .oriel/stages.json; none when there is no such file.
enum orl_result orl_stages_load(struct orl_job *job) ORL_CHECK_RESULT;
// What a stage's result depends on besides the stages before it, as its key has it. The caller
// releases it with json_decref.
json_t *orl_stage_settings(const struct orl_job *job, enum orl_stage_id id);
// Computes each stage's key from the collected photographs and the settings. Records the stage
// collect, which took `wall_s`, as done.
enum orl_result orl_stages_begin(struct orl_job *job, double wall_s) ORL_CHECK_RESULT;
// Runs the stages after collect whose key or result is missing. Before a stage changes any file,
// scene.json and the records of all dependent stages are removed.
enum orl_result orl_stages_run(struct orl_job *job) ORL_CHECK_RESULT;
// Records what refine took, which began at these times and is no stage: it reads the scene that all stages have made.
#define ORL_REFINE_RECORD "refine"
enum orl_result orl_stages_record_refine(struct orl_job *job, double start_s, double start_cpu_s) ORL_CHECK_RESULT;
// Runs densify and all later stages in a folder whose undistorted photographs and sparse model came
// from elsewhere.
enum orl_result orl_stages_run_points(struct orl_job *job) ORL_CHECK_RESULT;

#endif
