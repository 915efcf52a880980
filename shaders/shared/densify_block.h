// Parameter block of the densifier's shaders, shared by C and GLSL.
#ifndef ORL_DENSIFY_BLOCK_H
#define ORL_DENSIFY_BLOCK_H

#include "shared/interop.h"

#define ORL_DENSIFY_SOURCES_MAX 16

// A hypothesis is a plane, stored as its inverse depth w at the pixel and the slopes of w per
// pixel along x and y, since 1/z is affine in image coordinates. The rows of each source map
// (x, y, 1, w) to homogeneous coordinates, with x and y in reference pixels.
ORL_BLOCK(densify_block)
{
    VEC4S(forward, 48);  // reference pixel and w to source texel (its padding included)
    VEC4S(backward, 48); // source pixel and its w to reference pixel
    VEC4S(extent, 16);   // width, height; z: prior weight, 0: no such source; w: pixels of the
                         // source's depth map per texel
    VEC4(camera);        // reference: fx fy cx cy, pixels of this level
    VEC4(range);         // least and greatest w; z: change of w that shifts a match by a pixel
    VEC4(tune);          // refinement: x: depth change in pixels, y: normal change;
                         // z: weight of the reprojection error, w: its cap in pixels
    VEC4(limit);         // filter: greatest cost, greatest reprojection error in pixels,
                         // greatest cost of a matching view, greatest cost if one view agrees
    IVEC4(area);         // width, height, first row and end row of this dispatch
    IVEC4(run);          // seed, dispatch number, checkerboard colour (0 or 1), random tries
    IVEC4(tests);        // neighbours tried, refinements tried, views used; w: unused
};

#endif
