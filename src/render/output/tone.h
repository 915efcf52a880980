// Tone mapping: scene-linear light to display values, the same for pictures, video and viewers.
#ifndef ORL_RENDER_TONE_H
#define ORL_RENDER_TONE_H

#include "oriel/image.h"

enum orl_tone_curve {
    ORL_TONE_SRGB,     // clips at white, like a photograph of this exposure
    ORL_TONE_REINHARD, // Reinhard et al. 2002, equation 4, on luminance
    ORL_TONE_FILMIC,   // Narkowicz 2015, fit of the ACES reference curve, per channel
    ORL_TONE_DRAGO,    // Drago et al. 2003 (OpenCV)
    ORL_TONE_MANTIUK,  // Mantiuk et al. 2006 (OpenCV)
    ORL_TONE_COUNT
};

struct orl_tone_info {
    const char *name, *description;
    // The operator normalises the whole picture. The exposure then scales its result, and frames of
    // a video may differ in brightness.
    bool whole_picture;
};
// Indexed by enum orl_tone_curve.
extern const struct orl_tone_info orl_tones[ORL_TONE_COUNT];

struct orl_tone_params {
    enum orl_tone_curve curve;
    double exposure_ev; // light is multiplied by 2^exposure_ev
    double white;       // for reinhard: luminance, after exposure, that maps to white; > 0
};
#define ORL_TONE_DEFAULTS .curve = ORL_TONE_SRGB, .exposure_ev = 0, .white = 8

// Converts a scene-linear F32 x3 image to sRGB-encoded 8-bit RGB. NaN and negative light are black.
// With ORL_TONE_DEFAULTS the result is that of orl_tone_srgb, bit for bit.
enum orl_result orl_tone_apply(const struct orl_log *log, const struct orl_image *linear,
                               const struct orl_tone_params *params,
                               struct orl_image *srgb) ORL_CHECK_RESULT;

#endif
