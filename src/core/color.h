// The sRGB transfer functions (IEC 61966-2-1).
#ifndef ORL_CORE_COLOR_H
#define ORL_CORE_COLOR_H

#include "oriel/common.h"

// Converts linear light to an sRGB value, both 1 at white. The result is clamped to [0, 1]; NaN
// gives 0.
float orl_srgb_encode(float linear);
// The inverse of orl_srgb_encode, extended to all values from 0 on.
float orl_srgb_decode(float encoded);
// Luminance of linear Rec. 709 colour.
float orl_luminance(const float rgb[3]);

#endif
