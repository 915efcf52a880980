// Limits of splat radii, from how large the discs are in the photographs.
#ifndef ORL_SCENE_RADIUS_LIMITS_H
#define ORL_SCENE_RADIUS_LIMITS_H

#include "scene/point_radii.h"

struct orl_radii_limits {
    float largest_px;  // radii are limited to this size in the photograph that sees most detail
    float isolated_px; // points with larger radii are isolated and dropped
    float typical;     // both grow where a disc so many times the median would exceed largest_px;
                       // 0: they do not
};
#define ORL_RADII_LIMITS_DEFAULTS .largest_px = 9.0f, .isolated_px = 16.0f, .typical = 2.0f
// Of a cloud with a point for nearly each pixel. Between such points pull-push closes what is open,
// and larger discs reach past outlines.
#define ORL_RADII_LIMITS_DENSE .largest_px = 2.0f, .isolated_px = 16.0f, .typical = 0.0f

// The limits for radii of these parameters, those of a dense cloud or the defaults: in proportion to
// the radii that they give on a surface, where the distance to the k-th neighbour grows as the square
// root of k. So the same points are isolated, whatever the overlap.
struct orl_radii_limits orl_radii_limits_of(const struct orl_radii_params *params);

// Limits radii that the sampling of a fused cloud cannot explain. Stereo gives some
// outliers in mid-air, and with the distance to its neighbours as radius a single outlier
// may hide a whole picture. A disc's size in pixels is the largest among the photographs
// whose frame contains the point. Points in no frame stay unchanged.
enum orl_result orl_points_limit_radii(const struct orl_log *log,
                                       const struct orl_radii_limits *limits,
                                       const struct orl_view *views, size_t view_count,
                                       struct orl_points *points) ORL_CHECK_RESULT;

// Sets radii and limits them as orl_radii_limits_of says, for a cloud that these photographs see.
enum orl_result orl_points_find_radii(const struct orl_log *log, const struct orl_progress *progress,
                                      const struct orl_radii_params *params, const struct orl_view *views,
                                      size_t view_count, struct orl_points *points) ORL_CHECK_RESULT;

// --- the same for a cloud that is read in parts ---

// The sizes of all discs, counted by size: enough for their median.
struct orl_disc_sizes {
    uint64_t *counts; // owned
    uint64_t total;
};
enum orl_result orl_disc_sizes_init(const struct orl_log *log,
                                    struct orl_disc_sizes *sizes) ORL_CHECK_RESULT;
void orl_disc_sizes_finish(struct orl_disc_sizes *sizes);
// Counts the discs of these points, and sets the scale of each: pixels per scene unit, in the
// photograph that shows the point largest; 0: the point is in no photograph's frame.
void orl_disc_sizes_add(struct orl_disc_sizes *sizes, const struct orl_view *views,
                        size_t view_count, const struct orl_points *points, float *scales);
// The limits widened for a sparse cloud: its typical disc is as large as it must be to meet the
// next. `sizes` are those of all points.
struct orl_radii_limits orl_radii_limits_widened(const struct orl_radii_limits *limits,
                                                 const struct orl_disc_sizes *sizes);
// Limits the radii of these points and drops those that are isolated.
void orl_points_apply_limits(const struct orl_radii_limits *limits, const float *scales,
                             struct orl_points *points);

#endif
