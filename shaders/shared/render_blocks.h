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
    IVEC2(view_size);   // pixels
    INT(point_count);   // of this chunk
    INT(first_point);   // its index
    FLOAT(splat_scale); // options of these names
    FLOAT(front_layer);
    FLOAT(points_per_pixel);
    FLOAT(unused);
};
#endif

// One level of the pyramid.
#if defined(__STDC_VERSION__) || defined(BLOCK_PYRAMID)
ORL_BLOCK(pyramid_block)
{
    VEC4(camera); // fx fy cx cy, pixels of level 0
    IVEC2(level_size);  // of the written level
    INT(level_number);
    INT(least_support); // opt.min_support, whole
};
#endif

// Radiance is kept on the device times this and times trust: half floats have eleven bits
// above 2^-14, and linear exposures of interest, times trust, reach far below that.
#define ORL_RADIANCE_SCALE 4096.0

#define ORL_RADIANCE_KEPT 5 // photographs for the pixels of a tile, one work group
#define ORL_RADIANCE_LIST (ORL_RADIANCE_KEPT + 1) // and the best one's weight

// A photograph as the gather passes see it; an array of these is a storage buffer.
#define ORL_PHOTO_VEC4S 10
#if defined(__STDC_VERSION__)
struct photo_data {
    VEC4S(from_view, 3); // rows: rotation | translation, photograph's camera from the view's
    VEC4(eye);           // photograph's centre in the view's camera frame; w: slot
    VEC4(focal);         // fx fy cx cy of the resident photograph, pixels
    VEC4(size);          // width, height of the resident photograph; of its depth map
    VEC4(gain);          // rgb gain on linear colour; w: slot again, for sampling to load one less
    VEC4(lens);          // relative illumination: factors of r^2, r^4, r^6; w: r^2 per pixel^2
    VEC4(noise);         // of radiance: variance per light, of reading out; z: 1 if rounded
    VEC4(selected);      // x: what the selection weighs it
};
#endif

// The options of struct orl_render_params, as `opt`. C has struct render_options of
// src/render/option_list.h, to be included before; GLSL gets RENDER_OPTIONS, the same members, as a
// define that src/render/gather.c makes of the same list.
#if defined(BLOCK_GATHER)
struct render_options {
    RENDER_OPTIONS
};
#define RENDER_OPTIONS_MEMBER render_options opt
#elif defined(__STDC_VERSION__)
#define RENDER_OPTIONS_MEMBER _Alignas(16) struct render_options opt
#endif

// Photographs blended into the frame.
#if defined(ORL_RENDER_OPTIONS) || defined(BLOCK_GATHER)
ORL_BLOCK(gather_block)
{
    VEC4(view_focal);    // fx fy cx cy
    VEC4(ground);        // of image_block
    VEC4(slot_size);     // width, height of a photograph's slot; of a depth slot
    IVEC2(view_size);    // pixels
    INT(photo_count);    // of this dispatch
    INT(tiles_across);   // tiles in a row of the view
    INT(reach);          // opt.silhouette, whole pixels
    INT(kept);           // opt.photos_per_pixel, whole
    INT(asked);          // opt.candidates, whole
    FLOAT(last_mip);     // largest mip level
    FLOAT(border_px);    // opt.border_px in pixels of the photographs as they are on the device
    FLOAT(outlier_severity); // 1 / opt.outliers^2; 0: no sample is an outlier
    FLOAT(blur_per_radian);  // opt.guess_blur where depth is guessed, else 0; radians
    FLOAT(model_variance);   // of relative error at full exposure, of radiance
    FLOAT(least_radiance);   // that can be told from darkness
    RENDER_OPTIONS_MEMBER;
};
#endif

#define ORL_BICUBIC 1 // of opt.sampling

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
    IVEC2(image_size);  // of the written level
    INT(points_show);   // compose: splats' own colours, between which holes count as covered
    INT(fills);         // compose: pixels that nothing paints take their neighbours' colours
    VEC4(focal);        // fx fy cx cy
    VEC4(ground);       // dot(xyz, ray) is its inverse depth; w: the least that counts
    FLOAT(depth_scale); // a typical depth of the scene
    FLOAT(unused_1);
    FLOAT(unused_2);
    FLOAT(unused_3);
};
#endif

#endif
