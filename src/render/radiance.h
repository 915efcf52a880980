// Photographs as radiance: how much light each pixel says there was, and how far it can be
// believed. Radiance is relative to the scene's middle exposure: what gives white there is 1.
#ifndef ORL_RENDER_RADIANCE_H
#define ORL_RENDER_RADIANCE_H

#include "core/image.h"

// How a photograph's pixels came about.
struct orl_sensor {
    // Variance of a channel at linear exposure x, white being 1: shot * x + read^2; that of
    // rounding to 8 bits comes on top.
    double shot, read;
    // Relative error of every sample of a photograph that exposure does not explain:
    // geometry, resampling, gloss. Samples much better than this are equally good.
    double model;
    // Linear exposure above which a channel may be clipped: from `soft` to `hard` trust
    // falls to nothing.
    double soft, hard;
};
#define ORL_SENSOR_DEFAULTS .shot = 1e-4, .read = 2e-4, .model = 0.05, .soft = 0.75, .hard = 0.96

// Least trust in a pixel that says no more than "at least white".
#define ORL_TRUST_MIN 0x1p-22f

// Trust of one pixel as far as clipping goes, (0, 1]; peak: its largest channel's linear
// exposure; ev_above: its exposure in stops above the scene's darkest photograph. What clips
// keeps a trace of trust, most in the darkest photograph: where all clip, that says most.
float orl_clip_trust(const struct orl_sensor *sensor, float peak, float ev_above);
// Expected squared relative error of a pixel with these linear exposures, mean of its
// channels; rounded: to 8 bits. Trust as far as noise goes is m^2 / (m^2 + this), m being
// sensor->model: in proportion to the inverse of the expected squared error, as is best for
// a mean.
float orl_relative_variance(const struct orl_sensor *sensor, const float exposure[3],
                            bool rounded);
// Least radiance that differs from darkness, by one standard deviation, in a photograph
// `ev` stops brighter than the scene's middle.
float orl_least_radiance(const struct orl_sensor *sensor, float ev, bool rounded);

// One photograph's way from pixels to radiance.
struct orl_photo_response {
    const struct orl_sensor *sensor;
    const float (*linear)[256]; // [3][256]: linear exposure of each 8-bit value, 1 at 255;
                                // NULL: sRGB
    float vignette[3];          // as of struct orl_photo
    float centre[2];            // of vignetting: the principal point, pixels of the image
    float ev_above;             // exposure in stops above the scene's darkest photograph
};

// RGBA, F32: linear exposure, vignetting undone, times trust; and trust, as far as clipping
// goes. image: U8 x3 as in the file, or F32 x3, linear, which clips at 1 unless it holds
// larger values. Colour is divided by *white, the largest exposure, at least 1.
enum orl_result orl_radiance_decode(const struct orl_log *log,
                                    const struct orl_photo_response *response,
                                    const struct orl_image *image, struct orl_image *out,
                                    float *white) ORL_CHECK_RESULT;

#endif
