// Scene-linear light to what a screen shows: the same for pictures, video and viewers.
#ifndef ORL_RENDER_TONE_H
#define ORL_RENDER_TONE_H

#include "core/image.h"

enum orl_tone_curve {
    ORL_TONE_SRGB,     // clip at white: what a photograph of this exposure shows
    ORL_TONE_REINHARD, // Reinhard et al. 2002, equation 4, on luminance
    ORL_TONE_FILMIC,   // Narkowicz 2015, fit of the ACES reference curve, per channel
    ORL_TONE_DRAGO,    // Drago et al. 2003 (OpenCV)
    ORL_TONE_MANTIUK,  // Mantiuk et al. 2006 (OpenCV)
    ORL_TONE_COUNT
};

struct orl_tone_info {
    const char *name, *description;
    // Depends on the whole picture, which it brings to one range: exposure brightens its
    // result, and frames of a video may differ in brightness.
    bool whole_picture;
};
// By enum orl_tone_curve.
extern const struct orl_tone_info orl_tones[ORL_TONE_COUNT];

struct orl_tone_params {
    enum orl_tone_curve curve;
    double exposure_ev; // light is multiplied by 2^exposure_ev
    double white;       // of reinhard: the luminance, after exposure, that becomes white, > 0
};
#define ORL_TONE_DEFAULTS .curve = ORL_TONE_SRGB, .exposure_ev = 0, .white = 8

// sRGB-encoded 8-bit RGB of a scene-linear F32 x3 image. NaN and negative light are black.
// ORL_TONE_DEFAULTS is orl_tone_srgb, bit for bit.
enum orl_result orl_tone_apply(const struct orl_log *log, const struct orl_image *linear,
                               const struct orl_tone_params *params,
                               struct orl_image *srgb) ORL_CHECK_RESULT;

#endif
