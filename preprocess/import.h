// Makes a scene from known cameras and their pictures, without calibration: undistorted
// photographs, silhouettes, frames of a sequence, points and a mesh (docs/guide/import.md).
#ifndef ORL_PREPROCESS_IMPORT_H
#define ORL_PREPROCESS_IMPORT_H

#include "oriel/progress.h"
#include "preprocess/import/import_params.h"

// Makes the scene, completely or not at all. ORL_IMPORT_DENSIFY needs COLMAP, as orl_prepare does.
// ORL_ERR_ARGUMENT: OUT is not empty, or settings contradict each other. ORL_ERR_FORMAT,
// ORL_ERR_DATA: a file is damaged, or pictures do not fit their cameras. ORL_ERR_NOT_FOUND:
// pictures, masks or backgrounds are missing.
enum orl_result orl_import(const struct orl_log *log, const struct orl_import_params *params,
                           const struct orl_progress *progress) ORL_CHECK_RESULT;

#endif
