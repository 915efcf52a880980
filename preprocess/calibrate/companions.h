// The photographs and what travels with them, brought to the pixels of COLMAP's undistorted cameras with
// COLMAP's camera model.
#ifndef ORL_PREPROCESS_COMPANIONS_H
#define ORL_PREPROCESS_COMPANIONS_H

#include "preprocess/job/job.h"

enum orl_companion {
    // As SCENE/`out`/NAME. COLMAP's own JPEG files are 1.3 levels dark in red and blue and have half of
    // the colour resolution.
    ORL_COMPANION_PHOTO,
    ORL_COMPANION_LINEAR, // linear light of deep photographs, as SCENE/`out`/NAME.exr
    // As SCENE/`out`/NAME.png: 255 is the subject, 0 is not, or lies outside of what the photograph
    // shows.
    ORL_COMPANION_MASK,
};

// Writes one kind for all photographs of `undistorted` that have it. Makes the folder when there are
// any.
enum orl_result orl_undistort_companions(struct orl_job *job, enum orl_companion which,
                                         const struct orl_colmap_model *undistorted,
                                         const char *out, size_t *written) ORL_CHECK_RESULT;

#endif
