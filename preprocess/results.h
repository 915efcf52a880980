// Checksums of the files that a stage wrote. A later run finds damaged and missing files by them
// and makes these again.
#ifndef ORL_PREPROCESS_RESULTS_H
#define ORL_PREPROCESS_RESULTS_H

#include "preprocess/job/job.h"

// Adds {name in the scene: checksum} to `files`, for each file of `names` and for all files in its
// folders. NULL ends `names`. Missing files are left out.
enum orl_result orl_results_sum(const struct orl_job *job, const char *const *names,
                                json_t *files) ORL_CHECK_RESULT;
// Compares each file with its checksum. Returns the first that differs or is missing, *why being the
// reason; NULL: none.
const char *orl_results_check(const struct orl_job *job, const json_t *files, const char **why);

#endif
