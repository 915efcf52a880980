// Outliers in mid-air: points that photographs look through.
#ifndef ORL_SCENE_FREE_SPACE_H
#define ORL_SCENE_FREE_SPACE_H

#include "oriel/camera.h"
#include "oriel/points.h"
#include "oriel/progress.h"

// Drops points that stand alone in front of what photographs see behind them. A photograph looks
// through a point when, within a few pixels, points on all sides lie farther and hardly any lies as
// near; it confirms the point when a fair share does. A point is dropped that at least two
// photographs look through, and at least three times as many as confirm it. Points in no
// photograph's frame stay, and so do those that a known number of photographs agree on: fusion has
// compared them with whole depth maps. Needs no radii. `views`: the photographs' cameras;
// of many some are taken, evenly chosen.
// After the free-space violations of Merrell et al. 2007, "Real-time visibility-based fusion of
// depth maps", of points in place of depth maps.
enum orl_result orl_points_drop_in_free_space(const struct orl_log *log,
                                              const struct orl_progress *progress,
                                              const struct orl_view *views, size_t view_count,
                                              struct orl_points *points) ORL_CHECK_RESULT;

#endif
