// Parameter blocks of the frame; BLOCK_* says which one this shader uses.
#ifndef ORL_RENDER_BLOCKS_H
#define ORL_RENDER_BLOCKS_H

#include "shared/interop.h"

// Points that are culled and thinned together, and that are listed together for drawing.
#define ORL_BLOCK_POINTS 128
#define ORL_ITEM_POINTS 8
// Points that one invocation draws.
#define ORL_SPLAT_POINTS 4

// The view that points are splatted into.
#if defined(__STDC_VERSION__) || defined(BLOCK_SPLAT)
ORL_BLOCK(splat_block)
{
    VEC4S(rotation, 3); // rows of cam_from_world's rotation
    VEC4(eye);          // camera centre, world; w: nearest depth drawn
    VEC4(focal);        // fx fy cx cy, pixels
    VEC4(options);      // x: radius scale, y: front layer's thickness, fraction of depth,
                        // z: points per pixel above which blocks are thinned, 0: never
    IVEC4(size);        // width, height, points in this chunk, index of its first point
};
#endif

// One level of the pyramid.
#if defined(__STDC_VERSION__) || defined(BLOCK_PYRAMID)
ORL_BLOCK(pyramid_block)
{
    VEC4(camera); // fx fy cx cy, pixels of level 0
    IVEC4(level); // width, height and number of the written level, least support
};
#endif

// Radiance is kept on the device times this and times trust: half floats have eleven bits
// above 2^-14, and linear exposures of interest, times trust, reach far below that.
#define ORL_RADIANCE_SCALE 4096.0

#define ORL_RADIANCE_KEPT 5 // photographs for the pixels of a tile, one work group
#define ORL_RADIANCE_LIST (ORL_RADIANCE_KEPT + 1) // and the best one's weight

// A photograph as the gather passes see it; an array of these is a storage buffer.
#define ORL_PHOTO_VEC4S 9
#if defined(__STDC_VERSION__)
struct photo_data {
    VEC4S(from_view, 3); // rows: rotation | translation, photograph's camera from the view's
    VEC4(eye);           // photograph's centre in the view's camera frame; w: slot
    VEC4(focal);         // fx fy cx cy of the resident photograph, pixels
    VEC4(size);          // width, height of the resident photograph; of its depth map
    VEC4(gain);          // rgb gain on linear colour; w: slot again, for sampling to load one less
    VEC4(lens);          // relative illumination: factors of r^2, r^4, r^6; w: r^2 per pixel^2
    VEC4(noise);         // of radiance: variance per light, of reading out; z: 1 if rounded
};
#endif

// Photographs blended into the frame.
#if defined(__STDC_VERSION__) || defined(BLOCK_GATHER)
ORL_BLOCK(gather_block)
{
    VEC4(view_focal); // fx fy cx cy
    VEC4(options);    // x: depth tolerance, y: distance floor, z: border feather, pixels
    IVEC4(flags);     // x: 1 = test visibility, y: 1 = bicubic, z: pixels by which depth may
                      // reach past silhouettes
    IVEC4(area);      // width and height of the view, z: photographs, w: tiles per row
    VEC4(radiance);   // x: stops that samples of one surface may differ, 0: any;
                      // y: variance of relative error at full exposure; z: least radiance
                      // that can be told from darkness
    VEC4(choice);     // x: photographs per pixel, y: sharpness, z: trust in photographs
                      // without depth, w: sharpness on guessed depth
    VEC4(choice_more); // x: photographs of the tile's list that a pixel asks,
                       // y: severity with outliers, 1 / squared root of light; 0: none,
                       // z: largest mip level, w: blur on guessed depth per radian, radians
    VEC4(ground);      // of image_block
    VEC4(slots);       // width, height of a slot; of a depth slot
};
#endif

// Choice of photographs per tile.
#define CHOICE_TILE 16 // pixels
#define CANDIDATES 8   // photographs listed per tile
#define KEPT_MAX 4     // blended per pixel, at most
#define GUESS_BLUR_MOST 0.012 // of the picture's longer side
#define NOT_SEEN 1e30  // penalty of a photograph that cannot paint a pixel

// Image-space filling, and pixels from splat colours.
#if defined(__STDC_VERSION__) || defined(BLOCK_IMAGE)
ORL_BLOCK(image_block)
{
    IVEC4(area); // width, height of the written level; z, w: the pass's own
    VEC4(scale); // x: a typical depth of the scene
    VEC4(focal); // fx fy cx cy
    VEC4(ground); // dot(xyz, ray) is its inverse depth; w: the least that counts
};
#endif

#endif
