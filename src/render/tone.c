// Scene-linear light to what a screen shows.
#include <math.h>

#include "render/render.h"

// IEC 61966-2-1.
static float srgb_encode(float c)
{
    if (!(c > 0)) // also NaN
        return 0;
    if (c >= 1)
        return 1;
    return c <= 0.0031308f ? 12.92f * c : 1.055f * powf(c, 1 / 2.4f) - 0.055f;
}

enum orl_result orl_tone_srgb(const struct orl_log *log, const struct orl_image *linear,
                              struct orl_image *srgb)
{
    ORL_REQUIRE(log, linear->type == ORL_PIXEL_F32);
    enum orl_result result = orl_image_init(log, srgb, linear->width, linear->height,
                                            linear->channels, ORL_PIXEL_U8);
    if (result != ORL_OK)
        return result;
    size_t count = (size_t)linear->width * (size_t)linear->height * (size_t)linear->channels;
    for (size_t i = 0; i < count; i++)
        srgb->u8[i] = (uint8_t)lrintf(255 * srgb_encode(linear->f32[i]));
    return ORL_OK;
}
