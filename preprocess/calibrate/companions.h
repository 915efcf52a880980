// What travels with the photographs and COLMAP does not undistort: Oriel brings it to the same
// pixels with COLMAP's camera model.
#ifndef ORL_PREPROCESS_COMPANIONS_H
#define ORL_PREPROCESS_COMPANIONS_H

#include "preprocess/job/job.h"

// Linear light of all deep photographs of `undistorted`, as SCENE/`out`/NAME.exr. Makes the
// folder when there are any.
enum orl_result orl_undistort_linear(struct orl_job *job,
                                     const struct orl_colmap_model *undistorted, const char *out,
                                     size_t *written) ORL_CHECK_RESULT;
// The same of masks, as SCENE/`out`/NAME.png: 255 is the subject, 0 is not, or lies outside of
// what the photograph shows.
enum orl_result orl_undistort_masks(struct orl_job *job,
                                    const struct orl_colmap_model *undistorted, const char *out,
                                    size_t *written) ORL_CHECK_RESULT;

#endif
