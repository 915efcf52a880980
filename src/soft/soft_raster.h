// Draws soft splats into a view on the device.
#ifndef ORL_SOFT_SOFT_RASTER_H
#define ORL_SOFT_SOFT_RASTER_H

#include "oriel/camera.h"
#include "oriel/gpu.h"
#include "soft/lists.h"
#include "soft/model.h"

// Zero-initialised, it holds nothing.
struct orl_soft_raster {
    size_t count;
    struct orl_buf *splats, *projected, *bounds, *listed; // owned; as texels RGBA32F, RGBA32F, none, R32I
    struct orl_tex *blended;                     // owned: RGBA32F, with mip levels: sRGB colour, what passes
    uint32_t (*host_bounds)[ORL_SOFT_BOUND_WORDS]; // owned
    struct orl_soft_lists lists;
};

// Size of a dispatch of so many splats or tiles.
#define ORL_SOFT_SIZE(count) \
    {(int)((count) < ORL_SOFT_ROW ? (count) : ORL_SOFT_ROW), (int)orl_groups(count, ORL_SOFT_ROW)}

// Uploads the model, which must hold a splat.
enum orl_result orl_soft_raster_init(struct orl_gpu *gpu, const struct orl_soft_model *model,
                                     struct orl_soft_raster *raster) ORL_CHECK_RESULT;
void orl_soft_raster_finish(struct orl_gpu *gpu, struct orl_soft_raster *raster);
// Draws the view into raster->blended. smooths: the view is not one of those that the splats are adjusted to, and no
// splat is drawn sharper than the photographs that it was adjusted to. *block receives the parameters of the passes
// for this view, which later passes need, too.
enum orl_result orl_soft_raster_draw(struct orl_gpu *gpu, struct orl_soft_raster *raster,
                                     const struct orl_view *view, bool smooths,
                                     struct soft_block *block) ORL_CHECK_RESULT;

#endif
