// Differences of two 8-bit pictures.
#ifndef ORL_EVAL_METRICS_H
#define ORL_EVAL_METRICS_H

#include "oriel/image.h"

struct orl_metrics {
    double psnr_db;         // RGB, 8-bit sRGB values, whole picture; 100 when identical
    double psnr_cc_db;      // after the least-squares affine colour map (3x4) of a onto b
    double psnr_covered_db; // over pixels with coverage > 0.5; 0 when there are none
    double ssim;            // luma, Wang 2004: 11x11 Gaussian, sigma 1.5, whole picture
    double coverage;        // share of pixels with coverage > 0.5
    double completeness;    // Virtual Rephotography: share of pixels not left black
    double ncc_error;       // Virtual Rephotography: mean of 1 - NCC over complete patches, [0, 2]
    double crumbs;          // specks and torn edges: crumbs per 10,000 pixels
};

// a: rendered, b: photograph, both U8 x3 of one size; coverage F32 x1.
enum orl_result orl_metrics_compare(const struct orl_log *log, const struct orl_image *a,
                                    const struct orl_image *b, const struct orl_image *coverage,
                                    struct orl_metrics *metrics) ORL_CHECK_RESULT;

// A part of the picture, as the vehicle of oriel synth --vehicle. All 0 where nothing of it is shown.
struct orl_part_metrics {
    double psnr_db;  // over its pixels
    double crumbs;   // per 10,000 of its pixels
    double coverage; // share of its pixels with coverage > 0.5
};
// part: F32 x1, above 0.5 where it is; the rest as above.
enum orl_result orl_metrics_of_part(const struct orl_log *log, const struct orl_image *a,
                                    const struct orl_image *b, const struct orl_image *coverage,
                                    const struct orl_image *part,
                                    struct orl_part_metrics *metrics) ORL_CHECK_RESULT;
// FLIP: how large the difference of two pictures looks to a person who flips between them. LDR-FLIP of Andersson et al. 2020
// ("FLIP: A Difference Evaluator for Alternating Images"), at 67 pixels per degree of visual angle as in the authors' program.
// a, b: U8 x3, sRGB, of one size. *mean: over all pixels, 0 (equal) to 1. Symmetric in a and b.
enum orl_result orl_flip_compare(const struct orl_log *log, const struct orl_image *a,
                                 const struct orl_image *b, double *mean) ORL_CHECK_RESULT;
// In dB of `peak`, at most 100, from a sum of squared errors.
double orl_psnr_db(double squared_error, double count, double peak);
// psnr_db alone, and ssim alone.
double orl_metrics_psnr_db(const struct orl_image *a, const struct orl_image *b);
enum orl_result orl_metrics_ssim(const struct orl_log *log, const struct orl_image *a,
                                 const struct orl_image *b, double *ssim) ORL_CHECK_RESULT;

#endif
