// Private to src/render: the point cloud on the device.
#ifndef ORL_RENDER_CLOUD_H
#define ORL_RENDER_CLOUD_H

#include "render/render.h"
#include "shared/render_blocks.h"

// Points in chunks, so that no buffer is larger than a device takes. A chunk is blocks of
// ORL_BLOCK_POINTS points that are near one another. Each buffer has a view as texels.
struct point_chunk {
    struct orl_buf *positions, *attributes, *blocks, *enlarged, *items, *args;
    struct orl_tex *position_texels;  // RGBA32F: world xyz, radius
    struct orl_tex *attribute_texels; // RG32UI: octahedral normal, colour
    struct orl_tex *block_texels;     // RGBA32F: shaders/proxy/splat_cull.comp
    // Of the last cull; floats, then words:
    struct orl_tex *enlarged_texels, *item_texels, *arg_texels;
    int first, count, block_count;    // count: padded to whole blocks
};

struct cloud {
    struct point_chunk *chunks;
    size_t chunk_count;
};

// Sorts and uploads; points that are not finite are left out.
enum orl_result orl_cloud_init(struct orl_gpu *gpu, const struct orl_points *points,
                               struct cloud *cloud);
void orl_cloud_finish(struct orl_gpu *gpu, struct cloud *cloud);
// Lists what to draw of each chunk; sizes in `block` are overwritten.
void orl_cloud_cull(struct orl_gpu *gpu, const struct cloud *cloud, struct splat_block *block);

#endif
