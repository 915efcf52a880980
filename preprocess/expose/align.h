// Photometric alignment: exposure, white balance and vignetting between photographs, from
// co-visible samples.
#ifndef ORL_PREPROCESS_ALIGN_H
#define ORL_PREPROCESS_ALIGN_H

#include "preprocess/expose/samples.h"

struct orl_align_photo {
    bool known; // ev is set
    double ev;  // log2 of exposure, relative to the scene's reference
    int lens;   // photographs of one number share vignetting, from 0
    const float (*linear)[256]; // response of its camera, three channels; NULL: sRGB
    // Out:
    float gain[3];
    size_t samples; // observations that it was aligned by
    bool refused;   // its gain was not plausible: that of its exposure is used
};

struct orl_align_params {
    bool vignetting;
    double exposure_sigma_ev; // how far EXIF may be off
    double gain_sigma_ev;     // how far photographs of unknown exposure may differ
    double limit_ev;          // further off than this is not plausible
    double colour_limit_ev;   // nor are colours that differ by more
};
#define ORL_ALIGN_DEFAULTS .vignetting = true, .exposure_sigma_ev = 0.3, .gain_sigma_ev = 1.0, \
                           .limit_ev = 2.0, .colour_limit_ev = 1.0

struct orl_alignment {
    float (*vignette)[3];  // owned; per lens, as in struct orl_photo
    size_t lens_count;
    double spread_before_ev, spread_after_ev; // robust spread of a point's colours
};

// Robust least squares on log ratios of linear colour. Every photograph here takes part:
// held-out ones must not be given. Gains multiply linear colour. Where exposures are known
// gains are 2^-ev on average over those photographs, else 1 (geometric means, each channel).
enum orl_result orl_align(const struct orl_log *log, const struct orl_samples *samples,
                          const struct orl_align_params *params, struct orl_align_photo *photos,
                          size_t photo_count, struct orl_alignment *alignment) ORL_CHECK_RESULT;
void orl_alignment_finish(struct orl_alignment *alignment);

#endif
