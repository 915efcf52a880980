// Parameter blocks of the frame. Each shader defines BLOCK_* for the block that it uses.
#ifndef ORL_RENDER_BLOCKS_H
#define ORL_RENDER_BLOCKS_H

#include "shared/interop.h"

// Number of points that are culled together.
#define ORL_BLOCK_POINTS 128
// Texels that describe a block: centre of its bounds and points per unit of area; half extent of the
// bounds and number of points; corner that positions are counted from and their unit
// (src/scene/point_code.h).
#define ORL_BLOCK_VEC4S 3
// Number of points that one invocation draws, each of another block.
#define ORL_SPLAT_POINTS 4

// The view into which points are splatted.
#if defined(__STDC_VERSION__) || defined(BLOCK_SPLAT)
ORL_BLOCK(splat_block)
{
    VEC4S(rotation, 3); // rows of cam_from_world's rotation
    VEC4(eye);          // camera centre, world; w: nearest depth drawn
    VEC4(focal);        // fx fy cx cy, pixels
    IVEC2(view_size);   // pixels
    INT(point_count);   // points of this chunk
    INT(first_point);   // index of the chunk's first point
    FLOAT(splat_scale); // this and the next: the options of the same names
    FLOAT(front_layer);
    FLOAT(near);        // depth nearer than which large splats are outliers
};
#endif

// The view that a mesh is drawn into.
#if defined(__STDC_VERSION__) || defined(BLOCK_MESH)
ORL_BLOCK(mesh_block)
{
    VEC4S(rotation, 3); // rows of cam_from_world's rotation
    VEC4(eye);          // camera centre, world
    VEC4(focal);        // fx fy cx cy, pixels
    IVEC2(view_size);   // pixels
    FLOAT(depth_near);  // range of depths that is drawn
    FLOAT(depth_far);
};
#endif

// One level of the pyramid.
#if defined(__STDC_VERSION__) || defined(BLOCK_PYRAMID)
ORL_BLOCK(pyramid_block)
{
    VEC4(camera); // fx fy cx cy, pixels of level 0
    IVEC2(level_size);  // of the written level, pixels
    INT(level_number);
    FLOAT(front_layer); // opt.front_layer
};
#endif

// Radiance is stored on the device multiplied by this and by its confidence weight. Half floats
// have eleven bits of precision only above 2^-14, and linear exposure times confidence is often
// far smaller.
#define ORL_RADIANCE_SCALE 4096.0

#define ORL_RADIANCE_KEPT 5 // photographs listed for a tile, which is one work group
#define ORL_RADIANCE_LIST (ORL_RADIANCE_KEPT + 1) // and the best photograph's weight

// Parameters of a photograph for the gather passes. A storage buffer holds an array of these.
#define ORL_PHOTO_VEC4S 10
#if defined(__STDC_VERSION__)
struct photo_data {
    VEC4S(from_view, 3); // rows of rotation | translation: photo_from_view
    VEC4(eye);           // the photograph's centre in the view's camera frame; w: slot
    VEC4(focal);         // fx fy cx cy of the resident photograph, pixels
    VEC4(size);          // width, height of the resident photograph; width, height of its depth map
    VEC4(gain);          // rgb gain on linear colour; w: slot again, to save a load
    VEC4(lens);          // relative illumination: factors of r^2, r^4, r^6; w: r^2 per pixel^2
    VEC4(noise);         // of radiance: shot and read noise variance; z: 1 if rounded to 8 bits.
    VEC4(selected);      // x: weight by the selection
};
#endif

// The options of struct orl_render_params, as member `opt`. C has struct render_options of
// include/oriel/option_list.h, which must be included first. In GLSL the define RENDER_OPTIONS
// declares the same members; src/render/paint/gather.c generates it from the same list.
#if defined(BLOCK_GATHER)
struct render_options {
    RENDER_OPTIONS
};
#define RENDER_OPTIONS_MEMBER render_options opt
#elif defined(__STDC_VERSION__)
#define RENDER_OPTIONS_MEMBER _Alignas(16) struct render_options opt
#endif

// Parameters of the passes that blend photographs into the frame.
#if defined(ORL_RENDER_OPTIONS) || defined(BLOCK_GATHER)
ORL_BLOCK(gather_block)
{
    VEC4(view_focal);    // fx fy cx cy
    VEC4(ground);        // as in image_block
    VEC4(slot_size);     // width, height of a photograph's slot; width, height of a depth slot
    // Rows of rotation | translation: of the room to a space where its walls are at -1 and 1, or the shell
    // has radius 1.
    VEC4S(local_from_view, 3);
    IVEC2(view_size);    // pixels
    INT(photo_count);    // photographs of this dispatch
    INT(tiles_across);   // tiles in each row of the view
    FLOAT(last_mip);     // largest mip level
    FLOAT(border_px);    // pixels of the photographs as stored on the device; 0: they do not fade
    FLOAT(outlier_severity); // 1 / opt.outliers^2; 0: no outlier rejection
    FLOAT(blur_per_radian);  // opt.guess_blur if background depth is estimated, else 0; radians
    FLOAT(model_variance);   // of radiance: variance of the relative error at full exposure
    FLOAT(min_radiance);   // least radiance that differs from darkness
    FLOAT(billboard_half);   // half the width of a billboard, scene units
    FLOAT(min_inverse);    // inverse depth of the farthest one
    INT(tile_side);          // pixels of a tile each way, even
    RENDER_OPTIONS_MEMBER;
};
#endif

// Texture units of photographs' chroma, and of what soft splats show in them.
#define ORL_PHOTO_CHROMA 3
#define ORL_PHOTO_SOFT 4
#define ORL_BICUBIC 1 // value of opt.sampling

#define NOT_SEEN 1e30  // penalty of a photograph that cannot paint a pixel

// A photograph's depth map: estimates in its holes, or fat outlines; and what stands before the scene.
#if defined(__STDC_VERSION__) || defined(BLOCK_DEPTH_MAP)
ORL_BLOCK(depth_map_block)
{
    IVEC2(drawn_size);     // of the depth map that is read, pixels
    IVEC2(kept_size);      // of the one that is written
    FLOAT(line_offset);    // factor on the depth of outlines
    FLOAT(occluder_depth); // what occluders get, scene units
    FLOAT(unused0);
    FLOAT(unused1);
};
#endif

// Image-space hole filling and the final composition.
#if defined(__STDC_VERSION__) || defined(BLOCK_IMAGE)
#define ORL_FILL_RUN 8 // groups of pixels that one work group of hole filling looks at, at most 32

ORL_BLOCK(image_block)
{
    IVEC2(image_size);  // of the written level, pixels
    INT(points_show);   // compose: 1: the picture shows the splats' own colours
    INT(fills);         // compose: 1: unpainted pixels take their neighbours' colours
    VEC4(focal);        // fx fy cx cy
    VEC4(ground);       // dot(xyz, ray) is the ground's inverse depth; w: the least one used
    FLOAT(depth_scale); // a typical depth of the scene
    INT(layers);        // compose: 1: a pixel's weight is alpha, and it lies over what is behind
    IVEC2(pictures);    // mean: index of the picture, number of them
    FLOAT(footprint);   // antialias: pixels of a photograph in one of the view, each way
};
#endif

#endif
