// Private to src/render: one view on its way from surface to picture.
#ifndef ORL_RENDER_FRAME_H
#define ORL_RENDER_FRAME_H

#include "render/proxy.h"
#include "render/render.h"

struct photos;
struct gather;
struct fill;
struct soften;
struct edges;

// What every pass gets. Passes keep what outlives a frame in structs of their own.
struct frame {
    struct orl_gpu *gpu;
    const struct orl_scene *scene;
    const struct orl_view *view;
    const struct orl_render_params *params;
    bool radiance;             // photographs are radiance
    bool finishes;             // the painter leaves finished pixels (struct painter)
    const bool *skip;          // per photograph: not to be used; NULL: none
    struct proxy *proxy;       // draws surfaces: this view's and the photographs'
    uint64_t proxy_key;        // orl_proxy_key with these parameters
    struct surface surface;    // of the view
    struct photos *photos;     // on the device
    struct gather *gather;     // parameters of the photographs in use
    struct fill *fill;
    struct soften *soften;
    struct edges *edges;
    // Photographs of the scene that this frame asks, ascending; the renderer's memory.
    size_t *chosen;
    float *chosen_weight;      // what the selection weighs each
    size_t chosen_count;
    const double *centre;      // of the scene's bounding box, world
    // shaders/shared/pixel.glsl, finished in the end. Half floats where the painter finishes pixels.
    struct orl_tex *picture;
    struct orl_tex *trusted;   // of radiance: weight * trust, weight, blur of guesses; else NULL
    struct orl_tex *states[2]; // RGBA32F, what a combination keeps between sweeps, and what a
                               // filter writes; else NULL
};

// Work groups that cover width x height pixels.
void orl_pixel_groups(int width, int height, unsigned groups[3]);
// Does this frame guess depth where nothing covers a pixel?
bool orl_frame_guesses(const struct frame *frame);
// The scene's ground for image_block and gather_block: zeros where the frame's guesses may lie
// beyond it.
void orl_frame_ground(const struct frame *frame, float ground[4]);
void orl_set_focal(const struct orl_camera *camera, float focal[4]);

#endif
