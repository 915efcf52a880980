// Adjusts soft splats by descent on photographs (Kerbl 2023, without its densification: the points are there).
#ifndef ORL_SOFT_DESCENT_H
#define ORL_SOFT_DESCENT_H

#include "oriel/image.h"
#include "oriel/progress.h"
#include "soft/soft_raster.h"

// A photograph to adjust to.
struct orl_soft_photo {
    struct orl_view view;
    struct orl_image color; // F32 x3, sRGB at the scene's exposure, [0, 1], as large as the view
    struct orl_image use;   // U8 x1: 0 where it shows what stands before the scene; without data: the whole photograph is used
};

struct orl_soft_descent_params {
    int steps;
    double first_size; // factor on the step sizes of the first step, [0.1, 1]; that of the last one is 0.1
    uint64_t seed;     // of the order of the photographs
    double budget_s;   // no step begins after so long; 0: any
    double part_s;     // a call ends with the first pass over the photographs that is over after so long
    size_t max_bytes;  // of device memory; 0: any
    const struct orl_progress *progress; // NULL: none
};

// How far a descent has come; zeros: it has not begun.
struct orl_soft_descent_report {
    int steps;      // number of steps that were made
    double loss;    // running mean over the last steps
    double spent_s;
    bool done;
};

// Adjusts the model in place, from where the report says that it is. The caller goes on, in this process or another,
// with the model, the report and the same photographs and parameters, until the descent is done. The result is the same
// for the same seed on the same device, in whatever parts it was made. ORL_ERR_GPU: max_bytes are not enough.
enum orl_result orl_soft_descend(struct orl_gpu *gpu, const struct orl_soft_photo *photos, size_t count,
                                 const struct orl_soft_descent_params *params, struct orl_soft_model *model,
                                 struct orl_soft_descent_report *report) ORL_CHECK_RESULT;

// Device memory that a descent takes at most, bytes. entries: splats in the lists of all tiles of a view.
size_t orl_soft_descent_bytes(size_t splats, size_t entries, int width, int height);

// One step's device state, for a test of the gradients.
struct orl_soft_descent {
    struct orl_soft_raster raster;
    struct orl_buf *places, *shares, *mean, *square; // owned
    struct orl_tex *gradient_target;                 // owned
    struct orl_image picture, gradient;              // owned
    size_t max_bytes;                                // 0: any
};
enum orl_result orl_soft_descent_init(struct orl_gpu *gpu, const struct orl_soft_model *model,
                                      struct orl_soft_descent *descent) ORL_CHECK_RESULT;
// Draws the photograph's view and steps against the loss, whose value before the step is *loss. decay: factor
// on the step sizes; 0: the splats stay as they are.
enum orl_result orl_soft_descent_step(struct orl_gpu *gpu, struct orl_soft_descent *descent,
                                      const struct orl_soft_photo *photo, float decay,
                                      double *loss) ORL_CHECK_RESULT;
void orl_soft_descent_finish(struct orl_gpu *gpu, struct orl_soft_descent *descent);

// --- loss.c: how far a picture is from a photograph, and in which direction it should change ---

// The mean over pixels and channels of 0.8 |picture - photograph| + 0.2 (1 - SSIM) (Kerbl 2023, equation 7;
// SSIM of Wang 2004 with a Gaussian window of 11 pixels), both F32 of sRGB in [0, 1], the picture with 4
// channels, of which the last is not read, and the photograph with 3. gradient: F32 x4, of the loss by the
// picture's values; 0 where `use` (U8 x1; NULL: everywhere) is 0.
enum orl_result orl_soft_loss(const struct orl_log *log, const struct orl_image *picture,
                              const struct orl_image *photograph, const struct orl_image *use,
                              struct orl_image *gradient, double *loss) ORL_CHECK_RESULT;

#endif
