// Photometric alignment: exposure, white balance and vignetting between photographs, from
// co-visible samples.
#ifndef ORL_PREPROCESS_ALIGN_H
#define ORL_PREPROCESS_ALIGN_H

#include "preprocess/expose/samples.h"

struct orl_alignment {
    double spread_before_ev, spread_after_ev; // robust spread of a point's colours
};

// Robust least squares on log ratios of linear colour. The first `photo_count` photographs take
// part; those behind them, up to `all_count`, are held out and get the vignetting of their lens. Gains multiply linear colour. In each channel their
// geometric mean is that of 2^-ev over photographs with known exposures, or 1 when no exposure is
// known.
enum orl_result orl_align(const struct orl_log *log, const struct orl_samples *samples,
                          struct orl_exposed *photos, size_t photo_count, size_t all_count,
                          struct orl_alignment *alignment) ORL_CHECK_RESULT;
// True if a quarter or more of the photographs whose exposure is known look unlike it.
bool orl_align_contradicts(const struct orl_exposed *photos, size_t count);

#endif
