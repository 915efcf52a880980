// Private: points in blocks of neighbours, as the device stores them and files of levels of detail
// have them. A block can be skipped as a whole.
#ifndef ORL_SCENE_POINT_BLOCKS_H
#define ORL_SCENE_POINT_BLOCKS_H

#include "oriel/points.h"
#include "scene/point_code.h"
#include "shared/render_blocks.h"

// A cube around nearly all points, with a margin, so that a distant outlier does not merge all
// other points into one cell. Points outside belong to the outermost cells. With a cube the cells
// are cubes too, and blocks are equally wide in all directions.
struct point_cube {
    double low[3], side; // world, scene units
};
// Of some of the points, evenly chosen.
enum orl_result orl_point_cube_find(const struct orl_log *log, const struct orl_points *points,
                                    struct point_cube *cube) ORL_CHECK_RESULT;
// Place of a finite position on the Morton curve through the cube: 63 bits, of which each three,
// from the highest on, halve the cube once more in z, y and x.
uint64_t orl_point_cube_morton(const struct point_cube *cube, const float position[3]);

// The order in which points are stored, without those that are not finite: whole blocks of `size`
// entries, a power of two, along the Morton curve through the cube (NULL: that of the points), each
// shuffled so that any first part of it is spread evenly. Entries without a point are UINT32_MAX and
// come last in their block. *order is owned by the caller (free).
enum orl_result orl_point_order(const struct orl_log *log, const struct orl_points *points,
                                const struct point_cube *cube, size_t size, uint32_t **order,
                                size_t *count) ORL_CHECK_RESULT;

// A block: its points, and what shaders/proxy/splat_cull.comp reads of it and explains.
struct point_block {
    struct point_code codes[ORL_BLOCK_POINTS];
    float texels[ORL_BLOCK_VEC4S][4];
};
// The frame of a block's codes.
struct point_frame orl_point_block_frame(const float texels[ORL_BLOCK_VEC4S][4]);
// order: ORL_BLOCK_POINTS entries of a block.
void orl_point_block_make(const struct orl_points *points, const uint32_t *order,
                          struct point_block *block);

#endif
