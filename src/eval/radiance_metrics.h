// Differences of rendered and true radiance.
#ifndef ORL_EVAL_RADIANCE_METRICS_H
#define ORL_EVAL_RADIANCE_METRICS_H

#include "oriel/image.h"

// The luminance in cd/m2 assumed for radiance 1 (white at the scene's middle exposure): an ordinary
// display's white. PU21 then spans 14.3 stops below white and 6.6 above.
#define ORL_RADIANCE_CD_M2 100.0

struct orl_radiance_metrics {
    // PSNR of PU21-encoded R, G, B, peak 256, whole picture; 100 when identical.
    double pu21_psnr_db;
    // PSNR of mu-law-compressed R, G, B, mu 5000, of light relative to the truth's largest
    // value, clipped to [0, 1]; whole picture; 100 when identical.
    double mu_psnr_db;
    // Root mean square of log2(rendered / truth) over R, G, B of covered pixels, in stops.
    double log2_rmse;
    double log2_rmse_fitted; // the same after the least-squares factor, common to all pixels
};

// PU21's banding_glare encoding of light in cd/m2, clamped to [0.005, 10000]: Mantiuk and
// Azimi 2021, "PU21: A novel perceptually uniform encoding for adapting existing quality
// metrics for HDR"; coefficients of github.com/gfxdisp/pu21, matlab/pu21_encoder.m.
double orl_pu21_encode(double cd_m2);

// rendered and truth: F32 x3 of one size and unit; coverage: F32 x1 (covered above 0.5), or NULL:
// all covered. The log2 figures leave out samples whose truth is below 2^-20 of the truth's largest
// value, and raise rendered samples to that limit. ORL_ERR_DATA: the truth is all black.
enum orl_result orl_radiance_compare(const struct orl_log *log, const struct orl_image *rendered,
                                     const struct orl_image *truth,
                                     const struct orl_image *coverage,
                                     struct orl_radiance_metrics *metrics) ORL_CHECK_RESULT;

#endif
