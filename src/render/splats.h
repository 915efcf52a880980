// Private to src/render: what splats are drawn through. Passes see struct surface alone.
#ifndef ORL_RENDER_SPLATS_H
#define ORL_RENDER_SPLATS_H

#include "render/cloud.h"
#include "render/proxy.h"

enum { PYRAMID_LEVELS_MAX = 16 }; // for pictures of up to 2^16 pixels each way

// What splats are drawn through for one picture size.
struct splat_target {
    int width, height, levels;
    struct orl_tex *splat_depth;  // R32UI: bits of the nearest depth; all ones: empty
    struct orl_tex *splat_index;  // R32UI: the nearest point; all ones: empty
    struct orl_tex *splat_layer;  // R32UI: shaders/proxy/splat.glsl
    struct orl_tex *splats;       // RG32UI: level 0 of the pyramid: shaders/proxy/surfel.glsl; used
                                  // where normals are asked for
    struct orl_tex *chunk_splats; // RGBA32UI: what it was made from; NULL: points are one chunk
    struct orl_tex *surfel_a[PYRAMID_LEVELS_MAX]; // from level 1 on
    struct orl_tex *surfel_b[PYRAMID_LEVELS_MAX];
    struct orl_tex *pushed_depth; // before stray points are dropped
    struct orl_tex *depth, *normal; // of struct surface
};

#endif
