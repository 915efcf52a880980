// Private to src/render: the implementations behind the names of a method's slots.
#ifndef ORL_RENDER_METHOD_H
#define ORL_RENDER_METHOD_H

#include "oriel/render.h"

struct frame;

// A rule that selects the photographs that a frame asks.
struct orl_selection {
    const char *name;
    // Writes their indices in ascending order to frame->chosen. They may be more than fit on the device.
    enum orl_result (*choose)(struct frame *frame);
};

// How the samples of a pixel become one colour (shaders/gather/combine), and how this streams when
// the photographs do not all fit on the device. A combination of sums adds to them batch by batch;
// one that must know all samples before it can weigh one asks all photographs twice.
struct orl_combine {
    const char *name;
    int sweeps; // 1 or 2; 0: implemented by one painter only
    int states; // state images that are kept between sweeps, [0, 2]
    const char *radiance; // shader file in its place for radiance; NULL: that of methods
};

// A painter turns a surface into colours.
struct orl_painter {
    const char *name;
    const char *needs; // required choices, as readers of option_list.h; all must hold
    bool finishes;     // finishes all pixels that it does not list (shaders/shared/pixel.glsl),
                       // except in radiance
    bool layers;               // the fourth channel is alpha: what is behind shows through
    bool (*reads_normals)(const struct frame *frame); // the surface's normals; NULL: never
    enum orl_result (*paint)(struct frame *frame);
};

// --- the implementations; what each does is said where it is defined ---

extern const struct orl_proxy_kind orl_proxy_splats, orl_proxy_mesh, orl_proxy_hull, orl_proxy_voxels;
extern const struct orl_selection orl_select_all, orl_select_nearest, orl_select_preselect, orl_select_princ;
extern const struct orl_combine orl_combine_mean;
extern const struct orl_painter orl_paint_gather, orl_paint_tiled, orl_paint_points, orl_paint_billboards;
// Photographs of orl_select_princ beside those by direction, for surfaces that these see too obliquely.
enum { ORL_PRINC_EXTRAS = 3 };

// True if "key=name", which a space may end, holds for `sample` or for an option that is read.
bool orl_render_params_equal(const struct orl_render_params *params, const char *condition);
// The first of these conditions that is true, or else false; NULL: there is none.
const char *orl_render_params_first(const struct orl_render_params *params, const char *conditions, bool truth);

#endif
