// Exposure-normalised copies for COLMAP's features: SIFT finds next to nothing in photographs
// that are stops darker than the others.
#ifndef ORL_PREPROCESS_NORMALISE_H
#define ORL_PREPROCESS_NORMALISE_H

#include "preprocess/job/job.h"

// Do exposures differ so much that features need brightened copies?
bool orl_normalise_wanted(const struct orl_job *job);
// Fills SCENE/`dir` with brightened copies of dark photographs, counted, and links to the
// others; does nothing when they are not wanted.
enum orl_result orl_normalise(const struct orl_job *job, const char *dir,
                              size_t *copies) ORL_CHECK_RESULT;

#endif
