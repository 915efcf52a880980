// Parameters of the passes that draw soft splats and adjust them.
#ifndef ORL_SOFT_BLOCKS_H
#define ORL_SOFT_BLOCKS_H

#include "shared/interop.h"

// Vectors of four that describe a splat: position (world), logit of the opacity; logarithms of the standard
// deviations along its axes, size of a training photograph's pixel where the splat was first seen (0: never);
// its rotation, a quaternion wxyz of any length; and its colour (sRGB less a half) as the
// coefficient of the constant spherical harmonic, 0.
#define ORL_SOFT_VEC4S 4
// Vectors of four that describe a projected splat: centre (pixels), first two entries of the inverse
// covariance; its last one, opacity, depth, 0; colour, 1 for each channel that is above 0 as bits.
#define ORL_SOFT_SEEN_VEC4S 3
// Words of what the lists are made of: bits of the depth (0: not seen), first and last tile, x below y.
#define ORL_SOFT_BOUND_WORDS 3
// Vectors of four that a splat's gradient in a tile is: sums of the exponent's gradient, and of it times x, y and
// x^2; times x y and y^2, 0, 0; and sums of the colour's gradient, 0.
#define ORL_SOFT_SHARE_VEC4S 3
// Side of the tiles that share a list of splats, pixels.
#define ORL_SOFT_TILE 4
// Tiles of a work group.
#define ORL_SOFT_TILE_GROUP 64
// Splats or tiles in a row of work groups, of which a device may allow no more than 65,535.
#define ORL_SOFT_ROW (1 << 20)

#if defined(__STDC_VERSION__) || defined(BLOCK_SOFT)
ORL_BLOCK(soft_block)
{
    VEC4S(rotation, 3); // rows of cam_from_world's rotation
    VEC4(eye);          // camera centre, world; w: decay of the step sizes
    VEC4(focal);        // fx fy cx cy, pixels
    IVEC2(view_size);   // pixels
    INT(splat_count);
    INT(tiles_across);
    FLOAT(smooths);     // 1: no splat is drawn sharper than the photographs that it was adjusted to; else 0
    FLOAT(correct_share); // of the difference that the splats make, in the frame's picture
    FLOAT(mix_share);   // of the splats themselves in it
    FLOAT(mean_level);  // mip level of a difference that is its coarse part
};
#endif

#endif
