#include "core/color.h"

#include <math.h>

float orl_srgb_encode(float c)
{
    if (!(c > 0)) // true also for NaN
        return 0;
    if (c >= 1)
        return 1;
    return c <= 0.0031308f ? 12.92f * c : 1.055f * powf(c, 1 / 2.4f) - 0.055f;
}

float orl_srgb_decode(float c)
{
    return c <= 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
}

float orl_luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}
