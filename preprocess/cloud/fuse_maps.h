// Points from depth maps: each surface once, in the detail of the photograph that sees it best.
#ifndef ORL_PREPROCESS_FUSE_MAPS_H
#define ORL_PREPROCESS_FUSE_MAPS_H

#include "oriel/camera.h"
#include "oriel/image.h"
#include "oriel/points.h"

// The depth map of a photograph.
struct orl_depth_map {
    struct orl_view view;   // whose camera has the map's size
    struct orl_image depth; // z in scene units; 0: none. Without data: there is no map
};

// The pixels of one map that become points.
struct orl_fused_pixels {
    size_t count;
    uint32_t *pixel; // y * width + x, rising; owned
    uint8_t *agree;  // how many photographs agree on each, its own included; 255: at least; owned
};

// Finds the pixels of maps[which] that become points: those on which at least one of the other maps
// agrees, that few see past, and that none of those which show it sees in more detail. Of smooth
// surfaces, every second pixel in each direction; near steps of depth, all. `others` are indices of
// the maps that are asked.
enum orl_result orl_fuse_pixels_find(const struct orl_log *log, const struct orl_depth_map *maps,
                                     size_t which, const uint32_t *others, size_t other_count,
                                     struct orl_fused_pixels *found) ORL_CHECK_RESULT;
void orl_fused_pixels_finish(struct orl_fused_pixels *found);

// Writes the points of `found` to points[first] and on. `normal`: of the map's size, three floats a
// pixel, the photograph's camera frame. `picture`: the photograph, 8-bit RGB of the map's size.
// Radii are left unknown.
void orl_fuse_pixels_write(const struct orl_depth_map *map, const struct orl_fused_pixels *found,
                           const struct orl_image *normal, const struct orl_image *picture,
                           size_t first, struct orl_points *points);

#endif
