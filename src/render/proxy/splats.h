// Private to src/render: the proxy of splats. Other passes see struct surface only.
#ifndef ORL_RENDER_SPLATS_H
#define ORL_RENDER_SPLATS_H

#include "render/proxy/proxy.h"
#include "scene/point_lod.h"
#include "shared/render_blocks.h"

// --- cloud.c: the points on the device ---

// A part of the points, small enough that no buffer exceeds the device's limits. It consists of
// blocks of ORL_BLOCK_POINTS points that are close together. Each buffer has texels.
struct point_chunk {
    struct orl_buf *points;      // RG32UI: struct point_code's geometry
    struct orl_buf *colors;      // R8UI, three for each point; NULL until they are asked for
    struct orl_buf *blocks;      // RGBA32F, ORL_BLOCK_VEC4S per block: see there
    struct orl_buf *list, *args; // R32UI: blocks that are drawn, and how many, of the last cull
    int first, count, block_count;    // count: includes the padding to whole blocks
};

struct cloud {
    struct point_chunk *chunks;
    size_t chunk_count;
    const struct orl_points *points; // the scene's
    struct cloud_pages *pages; // what the one chunk holds, of a cloud with levels of detail; NULL: all points
    float near;                // of struct orl_scene
};

// Uploads the points without their colours in the order of orl_point_order, by which the splat index
// texture has them. Points with a value that is not finite are omitted. The points live as long as the
// cloud.
enum orl_result orl_cloud_init(struct orl_gpu *gpu, const struct orl_points *points,
                               struct cloud *cloud);
// Uploads the colours, unless they are there.
enum orl_result orl_cloud_bring_colors(struct orl_gpu *gpu, struct cloud *cloud) ORL_CHECK_RESULT;
// Makes one chunk of this many blocks without a point, with room for colours.
enum orl_result orl_cloud_empty_chunk(struct orl_gpu *gpu, size_t block_count,
                                      struct cloud *cloud) ORL_CHECK_RESULT;
// Bytes of device memory that the cloud takes, once its colours are there.
size_t orl_cloud_bytes(const struct cloud *cloud);
void orl_cloud_finish(struct orl_gpu *gpu, struct cloud *cloud);
// How many points a chunk may have on this device: whole blocks.
size_t orl_cloud_chunk_points(const struct orl_gpu *gpu);
// Lists the blocks to draw of each chunk. The counts and the first index in `block` are
// overwritten.
void orl_cloud_cull(struct orl_gpu *gpu, const struct cloud *cloud, struct splat_block *block);

// --- cloud_pages.c: the part of a cloud with levels of detail that a view needs ---

// Which pages are in the cloud's one chunk. `lod` must outlive it. max_bytes: of device memory;
// 0: as many pages as one chunk may have.
enum orl_result orl_cloud_pages_init(struct orl_gpu *gpu, const struct orl_lod *lod,
                                     size_t max_bytes, struct cloud *cloud) ORL_CHECK_RESULT;
void orl_cloud_pages_finish(struct cloud_pages **pages);
// Chooses the coarsest pages that have enough points in each pixel of the view, or coarser ones where there
// is no room, and brings those to the device that are not there. No point is drawn of any other page.
enum orl_result orl_cloud_pages_choose(const struct cloud *cloud,
                                       const struct orl_view *view) ORL_CHECK_RESULT;

// --- splats.c: the textures through which they are drawn ---

enum { PYRAMID_LEVELS_MAX = 16 }; // for pictures of up to 2^16 pixels in each direction

// The textures through which splats are drawn, for one picture size.
struct splat_target {
    struct surface surface;
    struct orl_tex *splat_depth;  // R32UI: bits of the nearest depth; all bits set: empty
    struct orl_tex *splat_index;  // R32UI: index of the nearest point; all bits set: empty
    struct orl_tex *splat_layer;  // R32UI: shaders/proxy/splat.glsl
    struct orl_tex *splats;       // RG32UI: level 0 of the pyramid (shaders/proxy/surfel.glsl),
                                  // used if normals are asked for
    struct orl_tex *pushed;       // R32F: depth before outliers are dropped
    struct orl_tex *chunk_splats; // RGBA32UI: surfels of level 0; NULL: points are one chunk
    struct orl_tex *surfel_a[PYRAMID_LEVELS_MAX]; // levels from 1 on
    struct orl_tex *surfel_b[PYRAMID_LEVELS_MAX];
};

// About the bytes that a target of this size takes.
size_t orl_splats_target_bytes(const struct cloud *cloud, int width, int height);

#endif
