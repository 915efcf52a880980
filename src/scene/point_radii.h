// Splat radii and missing normals from nearest neighbours (FLANN).
#ifndef ORL_SCENE_POINT_RADII_H
#define ORL_SCENE_POINT_RADII_H

#include "oriel/progress.h"
#include "oriel/camera.h"
#include "oriel/points.h"

struct orl_radii_params {
    int neighbours;   // number of neighbours k, [1, 64]
    float overlap;    // radius = overlap * distance to the k-th neighbour, (0, 8]
};
#define ORL_RADII_DEFAULTS .neighbours = 6, .overlap = 1.0f

// Sets the radius of every point from the distance to its k nearest neighbours,
// so that discs of neighbouring points overlap (Airieau 2012, section 3). Points
// without a normal (0 0 0) get that of a plane fitted to the neighbours, turned
// towards the nearest of `viewer_count` camera centres. Points that coincide with
// all their neighbours get the median radius.
enum orl_result orl_points_set_radii(const struct orl_log *log,
                                     const struct orl_progress *progress,
                                     const struct orl_radii_params *params,
                                     const double (*viewers)[3], size_t viewer_count,
                                     struct orl_points *points) ORL_CHECK_RESULT;

struct orl_radii_limits {
    float largest_px;  // radii are limited to this size in the photograph that sees most detail
    float isolated_px; // points with larger radii are isolated and dropped
};
#define ORL_RADII_LIMITS_DEFAULTS .largest_px = 9.0f, .isolated_px = 16.0f

// The limits for radii of these parameters: in proportion to the radii that they give on a surface,
// where the distance to the k-th neighbour grows as the square root of k. So the same points are
// isolated, whatever the overlap.
struct orl_radii_limits orl_radii_limits_of(const struct orl_radii_params *params);

// Limits radii that the sampling of a fused cloud cannot explain. Stereo gives some
// outliers in mid-air, and with the distance to its neighbours as radius a single outlier
// may hide a whole picture. A disc's size in pixels is the largest among the photographs
// whose frame contains the point. Points in no frame stay unchanged.
enum orl_result orl_points_limit_radii(const struct orl_log *log,
                                       const struct orl_radii_limits *limits,
                                       const struct orl_view *views, size_t view_count,
                                       struct orl_points *points) ORL_CHECK_RESULT;

// Sets radii and limits them, both with their defaults, for a cloud that these photographs see.
enum orl_result orl_points_find_radii(const struct orl_log *log, const struct orl_view *views,
                                      size_t view_count,
                                      struct orl_points *points) ORL_CHECK_RESULT;

#endif
