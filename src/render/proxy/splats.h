// Private to src/render: textures of the splat proxy. Other passes see struct surface only.
#ifndef ORL_RENDER_SPLATS_H
#define ORL_RENDER_SPLATS_H

#include "render/proxy/cloud.h"
#include "render/proxy/proxy.h"

enum { PYRAMID_LEVELS_MAX = 16 }; // for pictures of up to 2^16 pixels in each direction

// The textures through which splats are drawn, for one picture size.
struct splat_target {
    struct surface surface;
    struct orl_tex *splat_depth;  // R32UI: bits of the nearest depth; all bits set: empty
    struct orl_tex *splat_index;  // R32UI: index of the nearest point; all bits set: empty
    struct orl_tex *splat_layer;  // R32UI: shaders/proxy/splat.glsl
    struct orl_tex *splats;       // RG32UI: level 0 of the pyramid (shaders/proxy/surfel.glsl),
                                  // used if normals are asked for
    struct orl_tex *pushed;       // R32F: depth before outliers are dropped
    struct orl_tex *chunk_splats; // RGBA32UI: surfels of level 0; NULL: points are one chunk
    struct orl_tex *surfel_a[PYRAMID_LEVELS_MAX]; // levels from 1 on
    struct orl_tex *surfel_b[PYRAMID_LEVELS_MAX];
};

// About the bytes that a target of this size takes.
size_t orl_splats_target_bytes(const struct cloud *cloud, int width, int height);

#endif
