// Surfaces of a subject with silhouettes that stereo has left open are closed by its visual hull.
#ifndef ORL_PREPROCESS_CLOSE_HULL_H
#define ORL_PREPROCESS_CLOSE_HULL_H

#include "oriel/points.h"
#include "preprocess/job/job.h"

// Adds points of the hull to those that were fused from the maps of the photographs `train` (stereo/),
// and drops outliers that lie outside the silhouettes. Does nothing where the photographs have no
// silhouettes, or where many points lie outside them. The record says what was done.
enum orl_result orl_close_hull(struct orl_job *job, const struct orl_colmap_model *model,
                               const struct orl_names *train, struct orl_points *points,
                               json_t *record) ORL_CHECK_RESULT;

#endif
