// Splat radii and missing normals from nearest neighbours (FLANN).
#ifndef ORL_SCENE_RADII_H
#define ORL_SCENE_RADII_H

#include "core/progress.h"
#include "scene/points.h"

struct orl_radii_params {
    int neighbours;   // k, [1, 64]
    float overlap;    // radius = overlap * distance to the k-th neighbour, (0, 8]
};
#define ORL_RADII_DEFAULTS .neighbours = 6, .overlap = 1.0f

// Sets the radius of every point from the distance to its k nearest neighbours,
// so that discs of neighbouring points overlap (Airieau 2012, section 3), and a
// normal, by plane fit to them, where it is 0 0 0, turned towards the nearest of
// `viewer_count` camera centres. Points whose neighbours all coincide get the
// median radius.
enum orl_result orl_points_set_radii(const struct orl_log *log,
                                     const struct orl_progress *progress,
                                     const struct orl_radii_params *params,
                                     const double (*viewers)[3], size_t viewer_count,
                                     struct orl_points *points) ORL_CHECK_RESULT;

#endif
