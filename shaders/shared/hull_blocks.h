// Parameter blocks of the voxel hull. Each shader defines BLOCK_* for the block that it uses.
#ifndef ORL_HULL_BLOCKS_H
#define ORL_HULL_BLOCKS_H

#include "shared/interop.h"

// One camera's partial hull.
#if defined(__STDC_VERSION__) || defined(BLOCK_CARVE)
ORL_BLOCK(carve_block)
{
    VEC4S(camera_from_voxels, 3); // rows of rotation | translation, from units of a voxel
    VEC4(focal);                  // fx fy cx cy, pixels
    IVEC2(size);                  // of the silhouette, pixels
    INT(side);                    // voxels each way
    INT(open);                    // 1: the silhouette touches the picture's border
    FLOAT(most);                  // largest distance that is told apart, scene units
};
#endif

// Which voxels a photograph sees.
#if defined(__STDC_VERSION__) || defined(BLOCK_SEEN)
ORL_BLOCK(seen_block)
{
    VEC4S(rotation, 3); // rows of cam_from_world's rotation
    VEC4(eye);          // camera centre, world
    VEC4(focal);        // fx fy cx cy of the depth map, pixels
    IVEC2(size);        // of the depth map, pixels
    INT(voxel_count);
    INT(words);         // 32-bit words of a voxel's set of photographs
    INT(word);          // of this photograph
    INT(bit);
    FLOAT(voxel);       // edge, scene units
};
#endif

// Billboards without colours.
#if defined(__STDC_VERSION__) || defined(BLOCK_BILLBOARD)
ORL_BLOCK(billboard_block)
{
    VEC4S(rotation, 3);    // rows of cam_from_world's rotation
    VEC4(eye);             // camera centre, world
    VEC4(view_focal);      // fx fy cx cy, pixels
    IVEC2(view_size);      // pixels
    FLOAT(billboard_half); // half their width, scene units
};
#endif

#endif
