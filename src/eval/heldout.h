// The held-out protocol, for everything that compares renderings with photographs: which picture
// is compared with which, at which size and exposure.
#ifndef ORL_EVAL_HELDOUT_H
#define ORL_EVAL_HELDOUT_H

#include "oriel/render.h"

// A photograph that a rendering is compared with.
struct orl_heldout {
    size_t photo;             // index in the scene
    int divide;               // the picture is at 1/divide of the photograph's size
    struct orl_view view;     // to render it from
    struct orl_image picture; // owned: the photograph, U8 x3, of the view's size
};

// Reads a photograph at 1/divide of its size, averaged in linear light; at less where that
// would be smaller than a window of SSIM.
enum orl_result orl_heldout_load(const struct orl_log *log, const struct orl_scene *scene,
                                 size_t photo, int divide,
                                 struct orl_heldout *heldout) ORL_CHECK_RESULT;
// Averages divide x divide pixels in linear light, as photographs are; the rest of a row or
// column is left out. U8 x3.
enum orl_result orl_heldout_shrink(const struct orl_log *log, const struct orl_image *from,
                                   int divide, struct orl_image *to) ORL_CHECK_RESULT;
void orl_heldout_finish(struct orl_heldout *heldout);

// What the photograph's camera would have shown of a rendering of its view: `color` (F32 x3,
// changed) at the photograph's exposure, white balance and vignetting, as an 8-bit picture.
// None of these comes from the photograph's pixels. `render`: options that `color` was rendered
// with; NULL: it is radiance, and the camera's response applies too.
enum orl_result orl_heldout_expose(const struct orl_log *log, const struct orl_scene *scene,
                                   size_t photo, const struct orl_render_params *render,
                                   struct orl_image *color,
                                   struct orl_image *picture) ORL_CHECK_RESULT;

#endif
