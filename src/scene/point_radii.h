// Splat radii and missing normals from nearest neighbours (FLANN).
#ifndef ORL_SCENE_POINT_RADII_H
#define ORL_SCENE_POINT_RADII_H

#include "oriel/progress.h"
#include "oriel/camera.h"
#include "oriel/points.h"

struct orl_radii_params {
    int neighbours;   // number of neighbours k, [1, 64]
    float overlap;    // radius = overlap * distance to the k-th neighbour, (0, 8]
    bool dense;       // points lie as close as pixels of photographs (scene/radius_limits.h)
};
#define ORL_RADII_DEFAULTS .neighbours = 6, .overlap = 1.0f

// Sets the radius of every point from the distance to its k nearest neighbours,
// so that discs of neighbouring points overlap (Airieau 2012, section 3). Points
// without a normal (0 0 0) get that of a plane fitted to the neighbours, turned
// towards the nearest of the cameras. Points that coincide with all their
// neighbours get the median radius.
enum orl_result orl_points_set_radii(const struct orl_log *log,
                                     const struct orl_progress *progress,
                                     const struct orl_radii_params *params,
                                     const struct orl_view *views, size_t view_count,
                                     struct orl_points *points) ORL_CHECK_RESULT;

// The same for the first `own` points only, whose neighbours may be any. All must be usable
// (orl_point_usable).
enum orl_result orl_points_set_some_radii(const struct orl_log *log,
                                          const struct orl_progress *progress,
                                          const struct orl_radii_params *params,
                                          const struct orl_view *views, size_t view_count,
                                          size_t own, struct orl_points *points) ORL_CHECK_RESULT;

#endif
