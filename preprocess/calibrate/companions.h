// The photographs and what travels with them, brought to the pixels of COLMAP's undistorted cameras with
// COLMAP's camera model.
#ifndef ORL_PREPROCESS_COMPANIONS_H
#define ORL_PREPROCESS_COMPANIONS_H

#include "preprocess/job/job.h"

// All photographs of `undistorted`, as SCENE/`out`/NAME. COLMAP's own JPEG files are 1.3 levels dark in
// red and blue and have half of the colour resolution.
enum orl_result orl_undistort_photos(struct orl_job *job,
                                     const struct orl_colmap_model *undistorted,
                                     const char *out) ORL_CHECK_RESULT;
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
