// Private to src/render: the point cloud on the device.
#ifndef ORL_RENDER_CLOUD_H
#define ORL_RENDER_CLOUD_H

#include "oriel/render.h"
#include "shared/render_blocks.h"

// A part of the points, small enough that no buffer exceeds the device's limits. It consists of
// blocks of ORL_BLOCK_POINTS points that are close together. Each buffer has a view as texels.
struct point_chunk {
    struct orl_buf *positions, *attributes, *blocks, *enlarged, *items, *args;
    struct orl_tex *position_texels;  // RG32UI: struct point_code's position
    struct orl_tex *attribute_texels; // R32UI: its attributes
    struct orl_tex *block_texels;     // RGBA32F, ORL_BLOCK_VEC4S per block: see there
    // Results of the last cull: floats, then 32-bit words.
    struct orl_tex *enlarged_texels, *item_texels, *arg_texels;
    int first, count, block_count;    // count: includes the padding to whole blocks
};

struct cloud {
    struct point_chunk *chunks;
    size_t chunk_count;
    struct cloud_pages *pages; // what the one chunk holds (cloud_pages.h); NULL: all points
    float near;                // of struct orl_scene
};

// Sorts the points and uploads them. Points with a value that is not finite are omitted.
enum orl_result orl_cloud_init(struct orl_gpu *gpu, const struct orl_points *points,
                               struct cloud *cloud);
// Makes one chunk of this many blocks without a point.
enum orl_result orl_cloud_empty_chunk(struct orl_gpu *gpu, size_t block_count,
                                      struct cloud *cloud) ORL_CHECK_RESULT;
void orl_cloud_finish(struct orl_gpu *gpu, struct cloud *cloud);
// How many points a chunk may have on this device: whole blocks.
size_t orl_cloud_chunk_points(const struct orl_gpu *gpu);
// Finds which point of `points` each point on the device is: (*map)[i], owned by the caller (free),
// for index i of the splat index texture; UINT32_MAX: padding.
enum orl_result orl_cloud_map(const struct orl_gpu *gpu, const struct orl_points *points,
                              uint32_t **map, size_t *count) ORL_CHECK_RESULT;
// Lists the points to draw of each chunk. The counts and the first index in `block` are
// overwritten.
void orl_cloud_cull(struct orl_gpu *gpu, const struct cloud *cloud, struct splat_block *block);

#endif
