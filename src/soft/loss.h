// How far a picture is from a photograph, and in which direction it should change.
#ifndef ORL_SOFT_LOSS_H
#define ORL_SOFT_LOSS_H

#include "oriel/image.h"

// The mean over pixels and channels of 0.8 |picture - photograph| + 0.2 (1 - SSIM) (Kerbl 2023, equation 7;
// SSIM of Wang 2004 with a Gaussian window of 11 pixels), both F32 of sRGB in [0, 1], the picture with 4
// channels, of which the last is not read, and the photograph with 3. gradient: F32 x4, of the loss by the
// picture's values; 0 where `use` (U8 x1; NULL: everywhere) is 0.
enum orl_result orl_soft_loss(const struct orl_log *log, const struct orl_image *picture,
                              const struct orl_image *photograph, const struct orl_image *use,
                              struct orl_image *gradient, double *loss) ORL_CHECK_RESULT;

#endif
