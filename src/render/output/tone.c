#include "render/output/tone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/color.h"
#include "oriel/render.h"

const struct orl_tone_info orl_tones[ORL_TONE_COUNT] = {
    [ORL_TONE_SRGB] = {"srgb", "clips at white, as a photograph does", false},
    [ORL_TONE_REINHARD] = {"reinhard", "compresses highlights up to a white point", false},
    [ORL_TONE_FILMIC] = {"filmic", "film-like shoulder and toe (fit of ACES)", false},
    [ORL_TONE_DRAGO] = {"drago", "adaptive logarithm, whole range of the picture", true},
    [ORL_TONE_MANTIUK] = {"mantiuk", "contrast by contrast, whole range of the picture", true},
};

// Upper bound of light, so that the sun in a picture does not drive sums to infinity.
static const float light_max = 1e6f;

// --- curves: linear light in and out, 1 is white ---

// Reinhard, Stark, Shirley and Ferwerda 2002, equation 4.
static void reinhard(float rgb[3], float white)
{
    float l = orl_luminance(rgb);
    if (!(l > 0))
        return;
    float scale = (1 + l / (white * white)) / (1 + l);
    for (int c = 0; c < 3; c++)
        rgb[c] *= scale;
}

// Narkowicz 2015, "ACES Filmic Tone Mapping Curve". The factor is his match for the exposure of
// ACES.
static float filmic(float x)
{
    x *= 0.6f;
    return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
}

static void apply_curve(const struct orl_tone_params *params, float rgb[3])
{
    if (params->curve == ORL_TONE_REINHARD)
        reinhard(rgb, (float)params->white);
    else if (params->curve == ORL_TONE_FILMIC)
        for (int c = 0; c < 3; c++)
            rgb[c] = filmic(rgb[c]);
}

// Replaces NaN and negative values, which come from black or invalid pixels, by 0.
static float clean(float value)
{
    return value > 0 ? fminf(value, light_max) : 0;
}

// Applies a whole-picture operator; other curves leave the light unchanged.
static enum orl_result map_picture(const struct orl_log *log, const struct orl_image *linear,
                                   enum orl_tone_curve curve, struct orl_image *mapped)
{
    struct orl_image cleaned;
    ORL_TRY(orl_image_init(log, &cleaned, linear->width, linear->height, 3, ORL_PIXEL_F32));
    size_t count = (size_t)linear->width * (size_t)linear->height * 3;
    for (size_t i = 0; i < count; i++)
        cleaned.f32[i] = clean(linear->f32[i]);
    enum orl_result result = orl_bridge_tonemap(
        log, &cleaned, curve == ORL_TONE_DRAGO ? ORL_TONEMAP_DRAGO : ORL_TONEMAP_MANTIUK, mapped);
    orl_image_finish(&cleaned);
    return result;
}

enum orl_result orl_tone_apply(const struct orl_log *log, const struct orl_image *linear,
                               const struct orl_tone_params *params, struct orl_image *srgb)
{
    memset(srgb, 0, sizeof *srgb);
    ORL_REQUIRE(log, linear->type == ORL_PIXEL_F32 && linear->channels == 3 && linear->data);
    ORL_REQUIRE(log, params->curve >= 0 && params->curve < ORL_TONE_COUNT && params->white > 0);
    struct orl_image mapped = {0};
    if (orl_tones[params->curve].whole_picture)
        ORL_TRY(map_picture(log, linear, params->curve, &mapped));
    const float *light = mapped.data ? mapped.f32 : linear->f32;
    enum orl_result result = orl_image_init(log, srgb, linear->width, linear->height, 3,
                                            ORL_PIXEL_U8);
    size_t count = result == ORL_OK ? (size_t)linear->width * (size_t)linear->height : 0;
    float scale = (float)exp2(params->exposure_ev);
    for (size_t i = 0; i < count; i++) {
        float rgb[3];
        for (size_t c = 0; c < 3; c++)
            rgb[c] = clean(scale * light[3 * i + c]);
        apply_curve(params, rgb);
        for (size_t c = 0; c < 3; c++)
            srgb->u8[3 * i + c] = (uint8_t)lrintf(255 * orl_srgb_encode(rgb[c]));
    }
    orl_image_finish(&mapped);
    return result;
}

enum orl_result orl_tone_srgb(const struct orl_log *log, const struct orl_image *linear,
                              struct orl_image *srgb)
{
    return orl_tone_apply(log, linear, &(struct orl_tone_params){ORL_TONE_DEFAULTS}, srgb);
}
