// Parameter blocks of the frame; BLOCK_* says which one this shader uses.
#ifndef ORL_RENDER_BLOCKS_H
#define ORL_RENDER_BLOCKS_H

#include "interop.h"

// The view that points are splatted into.
#if defined(__STDC_VERSION__) || defined(BLOCK_SPLAT)
ORL_BLOCK(splat_block)
{
    VEC4S(rotation, 3); // rows of cam_from_world's rotation
    VEC4(eye);          // camera centre, world; w: nearest depth drawn
    VEC4(focal);        // fx fy cx cy, pixels
    VEC4(options);      // x: radius scale, y: front layer's thickness, fraction of depth
    IVEC4(size);        // width, height, points in this chunk, index of its first point
};
#endif

// One level of the pyramid.
#if defined(__STDC_VERSION__) || defined(BLOCK_PYRAMID)
ORL_BLOCK(pyramid_block)
{
    VEC4(camera); // fx fy cx cy, pixels of level 0
    IVEC4(level); // width, height and number of the written level; z: level number
};
#endif

// One photograph blended into the frame.
#if defined(__STDC_VERSION__) || defined(BLOCK_GATHER)
ORL_BLOCK(gather_block)
{
    VEC4S(photo_from_view, 3); // rows: rotation | translation
    VEC4(photo_eye);           // photograph's centre in the view's camera frame
    VEC4(view_focal);          // fx fy cx cy
    VEC4(photo_focal);         // fx fy cx cy, pixels of level 0
    VEC4(photo_size);          // width, height, largest mip level, border feather in pixels
    VEC4(gain);                // rgb gain on linear colour
    VEC4(options);             // x: depth tolerance, y: distance floor,
                               // z: 1 = test visibility, w: 1 = bicubic
    IVEC4(size);               // width and height of the view
};
#endif

// Image-space filling, and pixels from splat colours.
#if defined(__STDC_VERSION__) || defined(BLOCK_IMAGE)
ORL_BLOCK(image_block)
{
    IVEC4(area); // width, height of the written level; z: level number; w: option
};
#endif

#endif
