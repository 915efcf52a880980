// Photographs as radiance: how much light each pixel says there was, and how far it can be
// believed. Radiance is relative to the scene's middle exposure: what gives white there is 1.
#ifndef ORL_RENDER_RADIANCE_H
#define ORL_RENDER_RADIANCE_H

#include "core/image.h"

// How a photograph's pixels came about.
struct orl_sensor {
    // Variance of a channel at linear exposure x, white being 1: shot * x + read^2, and
    // that of rounding to 8 bits.
    double shot, read;
    // Relative error of every sample of a photograph that exposure does not explain:
    // geometry, resampling, gloss. Samples much better than this are equally good.
    double model;
    // Linear exposure above which a channel may be clipped: from `soft` to `hard` trust
    // falls to nothing.
    double soft, hard;
};
#define ORL_SENSOR_DEFAULTS .shot = 1e-4, .read = 2e-4, .model = 0.05, .soft = 0.75, .hard = 0.96

// Trust of samples that say little more than "at least white" or "at most black".
#define ORL_TRUST_MIN 0x1p-22f

// One photograph's way from pixels to radiance.
struct orl_photo_response {
    const struct orl_sensor *sensor;
    const float (*linear)[256]; // [3][256]: linear exposure of each 8-bit value, 1 at 255;
                                // NULL: sRGB
    float vignette[3];          // as of struct orl_photo
    float centre[2];            // of vignetting: the principal point, pixels of the image
    bool clips;                 // false: values above 1 are as good as any (linear files)
    float ev;                   // exposure in stops, relative to the scene's middle
    float ev_darkest, ev_brightest; // of all photographs of the scene
};

// Trust in (0, 1] of one pixel, x being its three linear exposures before vignetting is
// undone, `slope` the linear step between neighbouring 8-bit values there (0: not rounded),
// `peak` the largest exposure in its neighbourhood. Proportional to 1 / (expected squared
// relative error), which is what makes a mean of samples best. Samples without
// information keep a small trust, largest for the darkest photograph when they clip and for
// the brightest when they are black, so that a pixel that nothing else has seen takes the
// best bound there is.
float orl_trust(const struct orl_photo_response *response, const float x[3],
                const float slope[3], float peak);

// RGBA, F32: linear exposure with vignetting undone times trust, and trust. image: U8 x3 as
// in the file, or F32 x3, linear. Exposures are not divided out yet.
enum orl_result orl_radiance_decode(const struct orl_log *log,
                                    const struct orl_photo_response *response,
                                    const struct orl_image *image,
                                    struct orl_image *out) ORL_CHECK_RESULT;

#endif
