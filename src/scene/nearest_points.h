// The nearest point of a cloud (FLANN, an exact search).
#ifndef ORL_SCENE_NEAREST_POINTS_H
#define ORL_SCENE_NEAREST_POINTS_H

#include "oriel/points.h"

// Finds for each of `queries` its nearest point: found[i] is an index into `points`, dist2[i] the
// square of the distance. All must be usable (orl_point_usable), and `points` not empty.
enum orl_result orl_points_nearest(const struct orl_log *log, const struct orl_points *points,
                                   const struct orl_points *queries, int *found,
                                   float *dist2) ORL_CHECK_RESULT;

#endif
