// The held-out protocol of all comparisons of renderings with photographs: which pictures are
// compared, at which size and exposure.
#ifndef ORL_EVAL_HELDOUT_H
#define ORL_EVAL_HELDOUT_H

#include "eval/metrics.h"
#include "oriel/render.h"

// A photograph that a rendering is compared with.
struct orl_heldout {
    size_t photo;             // index in the scene
    int divide;               // the picture is at 1/divide of the photograph's size
    struct orl_view view;     // the view to render
    struct orl_image picture; // owned: the photograph at the view's size, U8 x3
};

// Reads a photograph at 1/divide of its size, averaged in linear light. `divide` is reduced when
// the picture would be smaller than a window of SSIM.
enum orl_result orl_heldout_load(const struct orl_log *log, const struct orl_scene *scene,
                                 size_t photo, int divide,
                                 struct orl_heldout *heldout) ORL_CHECK_RESULT;
// The number of photographs that are held out.
size_t orl_heldout_count(const struct orl_scene *scene);
// True for `most` photographs, evenly chosen of those that are held out (test), or are not; for all
// of them if there are fewer, or if most is 0.
bool orl_heldout_chosen(const struct orl_scene *scene, bool test, size_t most, size_t photo);
// Averages divide x divide pixels in linear light. Pixels left over at the end of a row or column
// are dropped. U8 x3.
enum orl_result orl_heldout_shrink(const struct orl_log *log, const struct orl_image *from,
                                   int divide, struct orl_image *to) ORL_CHECK_RESULT;
void orl_heldout_finish(struct orl_heldout *heldout);

// Makes what the photograph's camera would show of a rendering of its view: brings `color` (F32 x3,
// overwritten) to the photograph's exposure, white balance and vignetting, as an 8-bit picture.
// None of these is taken from the photograph's pixels. `render`: the options of the rendering;
// NULL: `color` is radiance, and the camera's response is applied too.
enum orl_result orl_heldout_expose(const struct orl_log *log, const struct orl_scene *scene,
                                   size_t photo, const struct orl_render_params *render,
                                   struct orl_image *color,
                                   struct orl_image *picture) ORL_CHECK_RESULT;

// Renders the photograph's view without the photographs that `skip` marks (NULL: none), as
// orl_renderer_draw does, and makes of it what the photograph's camera would show: *picture as of
// orl_heldout_expose. `scene` is the one that the photograph was loaded from; the renderer may draw
// another of the same place. *coverage (NULL: not wanted) is that of the frame. Both are empty after a failure.
enum orl_result orl_heldout_draw(const struct orl_log *log, struct orl_renderer *renderer,
                                 const struct orl_scene *scene, const struct orl_heldout *heldout,
                                 const struct orl_render_params *render, const bool *skip,
                                 struct orl_image *picture,
                                 struct orl_image *coverage) ORL_CHECK_RESULT;

#endif
