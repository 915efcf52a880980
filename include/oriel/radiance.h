// Photographs as radiance: the radiance of each pixel and its confidence weight ("trust" in
// identifiers). Radiance is relative to the scene's middle exposure, where 1 is white.
#ifndef ORIEL_RADIANCE_H
#define ORIEL_RADIANCE_H

#include "oriel/image.h"

// Noise and clipping model of a photograph's sensor.
struct orl_sensor {
    // Variance of a channel at linear exposure x, where 1 is white: shot * x + read^2. The variance
    // of rounding to 8 bits is added to it.
    double shot, read;
    // Relative error of every sample that does not depend on the exposure: geometry, resampling,
    // gloss. Samples with much less noise than this count equally.
    double model;
    // Range of linear exposure in which a channel becomes unreliable as it clips: from `soft` to
    // `hard` the confidence falls to almost zero.
    double soft, hard;
};
#define ORL_SENSOR_DEFAULTS .shot = 1e-4, .read = 2e-4, .model = 0.05, .soft = 0.75, .hard = 0.96

// Confidence in a clipped pixel, which says only "at least white".
#define ORL_TRUST_MIN 0x1p-22f

// Confidence of one pixel with respect to clipping, (0, 1]. peak: linear exposure of its largest
// channel; ev_above: exposure in stops above the scene's darkest photograph. Clipped pixels keep a
// minimal confidence, greatest in the darkest photograph: where all photographs clip, its lower
// bound is the highest.
float orl_clip_trust(const struct orl_sensor *sensor, float peak, float ev_above);
// Expected squared relative error of a pixel with these linear exposures, averaged over its
// channels. rounded: to 8 bits. The confidence with respect to noise is m^2 / (m^2 + this), with
// m = sensor->model. It is proportional to the inverse of the expected squared error, which is
// optimal for a weighted mean.
float orl_relative_variance(const struct orl_sensor *sensor, const float exposure[3],
                            bool rounded);
// Least radiance that exceeds darkness by one standard deviation, in a photograph `ev` stops
// brighter than the scene's middle exposure.
float orl_least_radiance(const struct orl_sensor *sensor, float ev, bool rounded);

// The conversion of one photograph's pixels to radiance.
struct orl_photo_response {
    const struct orl_sensor *sensor;
    const float (*linear)[256]; // [3][256]: linear exposure of each 8-bit value, 1 at 255;
                                // NULL: sRGB
    float vignette[3];          // as in struct orl_photo
    float centre[2];            // centre of vignetting: the principal point, pixels of the image
    float ev_above;             // exposure in stops above the scene's darkest photograph
    bool unclipped;             // no value is clipped, however near to white
};

// Converts a photograph to F32 RGBA: linear exposure without vignetting, times the confidence, and
// the confidence with respect to clipping. image: U8 x3 as in the file, or linear F32 x3, which
// clips at 1 unless it holds larger values. Colour is divided by *white, the largest exposure, at
// least 1. The caller owns `out`.
enum orl_result orl_radiance_decode(const struct orl_log *log,
                                    const struct orl_photo_response *response,
                                    const struct orl_image *image, struct orl_image *out,
                                    float *white) ORL_CHECK_RESULT;

#endif
