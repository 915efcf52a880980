// From known cameras and their pictures to a scene, without calibration: undistorted
// photographs, silhouettes, moments of a sequence, points, a mesh (docs/guide/import.md).
#ifndef ORL_PREPROCESS_IMPORT_H
#define ORL_PREPROCESS_IMPORT_H

#include "oriel/progress.h"
#include "preprocess/import/import_params.h"

// Makes the scene, whole or not at all. ORL_IMPORT_DENSIFY needs COLMAP, as orl_prepare does.
// ORL_ERR_ARGUMENT: OUT is not free, or settings do not go together. ORL_ERR_FORMAT,
// ORL_ERR_DATA: a damaged file, or pictures that do not fit their cameras. ORL_ERR_NOT_FOUND:
// pictures, masks or backgrounds that are not there.
enum orl_result orl_import(const struct orl_log *log, const struct orl_import_params *params,
                           const struct orl_progress *progress) ORL_CHECK_RESULT;

#endif
