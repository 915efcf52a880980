// Exposure-normalised copies for COLMAP's features: SIFT finds few features in photographs that are
// stops darker than the others.
#ifndef ORL_PREPROCESS_NORMALISE_H
#define ORL_PREPROCESS_NORMALISE_H

#include "preprocess/job/job.h"

// True when exposures differ so much that features need brightened copies.
bool orl_normalise_wanted(const struct orl_job *job);
// Fills SCENE/`dir` with brightened copies of dark photographs, which it counts, and links to the
// others. Does nothing when copies are not needed.
enum orl_result orl_normalise(const struct orl_job *job, const char *dir,
                              size_t *copies) ORL_CHECK_RESULT;

#endif
