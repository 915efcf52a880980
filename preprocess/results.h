// The files that a stage left, by what is in them: what a later run finds damaged, or not at
// all, is made again.
#ifndef ORL_PREPROCESS_RESULTS_H
#define ORL_PREPROCESS_RESULTS_H

#include "preprocess/job/job.h"

// Adds {name in the scene: checksum} of each file `names` (files, and folders with all in them;
// NULL ends the list) to `files`. What is not there is left out.
enum orl_result orl_results_sum(const struct orl_job *job, const char *const *names,
                                json_t *files) ORL_CHECK_RESULT;
// Is each file there as it was summed up? The first that is not is in *damaged, with what is
// wrong in *why.
enum orl_result orl_results_check(const struct orl_job *job, const json_t *files,
                                  const char **damaged, const char **why) ORL_CHECK_RESULT;

#endif
