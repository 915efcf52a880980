// Points for the parts of a subject that stereo has not found, from its visual hull.
#ifndef ORL_PREPROCESS_HULL_POINTS_H
#define ORL_PREPROCESS_HULL_POINTS_H

#include "oriel/points.h"
#include "preprocess/cloud/fuse_maps.h"
#include "scene/cones.h"

// What a silhouette says of a place.
enum orl_silhouette_test { ORL_SILHOUETTE_UNSEEN, ORL_SILHOUETTE_OUTSIDE, ORL_SILHOUETTE_INSIDE };

// `pixel`: where the photograph shows the place, if it does.
enum orl_silhouette_test orl_silhouette_ask(const struct orl_silhouette *silhouette,
                                            const double world[3], double pixel[2]);

// A cube of voxels around the points, carved by silhouettes (the visual hull, Laurentini 1994) and
// by what depth maps see through (space carving, Kutulakos and Seitz 2000).
struct orl_hull_points {
    const struct orl_silhouette *silhouettes; // not owned
    size_t count;
    struct orl_hull cube;
    uint8_t *inside;  // side^3: 1 where the voxel is part of the hull; owned
    uint8_t *through; // side^3: how many maps see through the voxel; owned
    bool *outside;    // of each point: too many silhouettes exclude it; owned
    double outside_share; // of the points, each counted as often as other photographs agree on it
};

// Carves the cube by the silhouettes of `count` photographs. One in 32 of them may be wrong. Points
// must be usable. The cube's voxels take at most `max_bytes` (0: no limit), which makes them coarser. `silhouettes` must outlive the hull. On success and failure alike, the caller must
// call orl_hull_points_finish.
enum orl_result orl_hull_points_begin(const struct orl_log *log,
                                      const struct orl_silhouette *silhouettes, size_t count,
                                      const struct orl_points *points, size_t max_bytes,
                                      struct orl_hull_points *hull) ORL_CHECK_RESULT;
// Notes which voxels the depth map of photograph `which` sees through. Depth beside the silhouette
// does not count.
void orl_hull_points_see(struct orl_hull_points *hull, size_t which,
                         const struct orl_depth_map *map);
// Drops the points outside silhouettes that lie near what is left, outliers and fringes, and appends
// points on its surface, where there are no others: with normals, without radius and colour, on which
// 0 photographs agree. Parts without any points are left out. `added`: the first of the new points.
enum orl_result orl_hull_points_end(const struct orl_log *log, struct orl_hull_points *hull,
                                    struct orl_points *points, size_t *added) ORL_CHECK_RESULT;
void orl_hull_points_finish(struct orl_hull_points *hull);

#endif
