#include "oriel/radiance.h"

#include <math.h>
#include <string.h>

#include "core/color.h"

// --- confidence; shaders/gather/radiance/trust.glsl has the same noise model ---

float orl_clip_trust(const struct orl_sensor *sensor, float peak, float ev_above)
{
    double over = ((double)peak - sensor->soft) / (sensor->hard - sensor->soft);
    over = over < 0 ? 0 : over > 1 ? 1 : over;
    double fall = 1 - over * over * (3 - 2 * over);
    double bound = fmax(0x1p-10 * exp2(-2 * (double)ev_above), (double)ORL_TRUST_MIN);
    return (float)(bound + (1 - bound) * fall);
}

// Step between adjacent 8-bit sRGB values at linear exposure x, within a tenth where rounding
// matters.
static double step_at(double x)
{
    return fmax(1 / 12.92, 1.6 * sqrt(x)) / 255;
}

static double variance(const struct orl_sensor *sensor, double x, bool rounded)
{
    double step = rounded ? step_at(x) : 0;
    return sensor->shot * x + sensor->read * sensor->read + step * step / 12;
}

float orl_relative_variance(const struct orl_sensor *sensor, const float exposure[3],
                            bool rounded)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        double x = fmax((double)exposure[c], 1e-9);
        sum += variance(sensor, x, rounded) / (x * x) / 3;
    }
    return (float)sum;
}

float orl_least_radiance(const struct orl_sensor *sensor, float ev, bool rounded)
{
    return (float)(sqrt(variance(sensor, 0, rounded)) * exp2(-(double)ev));
}

// --- whole photographs ---

// Relative illumination at a squared distance r2 from the centre, in half diagonals.
static float light_at(const float vignette[3], float r2)
{
    return fmaxf(1 + r2 * (vignette[0] + r2 * (vignette[1] + r2 * vignette[2])), 0.1f);
}

struct decoder {
    const struct orl_photo_response *response;
    float linear[3][256];
    float white;
    bool clips;
};

static float exposure_at(const struct decoder *d, const struct orl_image *image, size_t at,
                         size_t channel)
{
    float x = image->type == ORL_PIXEL_U8 ? d->linear[channel][image->u8[at]] : image->f32[at];
    return x > 0 ? x : 0; // NaN becomes 0
}

static void init_decoder(const struct orl_photo_response *response, const struct orl_image *image,
                         struct decoder *d)
{
    d->response = response;
    for (size_t c = 0; c < 3; c++)
        for (int v = 0; v < 256; v++)
            d->linear[c][v] = response->linear ? response->linear[c][v]
                                               : orl_srgb_decode((float)v / 255);
    size_t values = 3 * (size_t)image->width * (size_t)image->height;
    d->white = 1;
    for (size_t i = 0; i < values && image->type == ORL_PIXEL_F32; i++)
        if (isfinite(image->f32[i]))
            d->white = fmaxf(d->white, image->f32[i]);
    // Interpolation and sharpening overshoot a little in files that clip at 1.
    d->clips = !response->unclipped && d->white < 1.5f;
}

static void decode_pixel(const struct decoder *d, const struct orl_image *image, int x, int y,
                         float out[4])
{
    const struct orl_photo_response *r = d->response;
    size_t at = 3 * ((size_t)y * (size_t)image->width + (size_t)x);
    float value[3], peak = 0;
    for (size_t c = 0; c < 3; c++) {
        value[c] = exposure_at(d, image, at + c, c);
        peak = fmaxf(peak, value[c]);
    }
    float half[2] = {0.5f * (float)image->width, 0.5f * (float)image->height};
    float dx = (float)x + 0.5f - r->centre[0], dy = (float)y + 0.5f - r->centre[1];
    float light = light_at(r->vignette, (dx * dx + dy * dy) /
                                            (half[0] * half[0] + half[1] * half[1]));
    float trust = isfinite(peak) ? d->clips ? orl_clip_trust(r->sensor, peak, r->ev_above) : 1 : 0;
    for (int c = 0; c < 3; c++)
        out[c] = trust > 0 ? trust * value[c] / (light * d->white) : 0;
    out[3] = trust;
}

enum orl_result orl_radiance_decode(const struct orl_log *log,
                                    const struct orl_photo_response *response,
                                    const struct orl_image *image, struct orl_image *out,
                                    float *white)
{
    memset(out, 0, sizeof *out);
    ORL_REQUIRE(log, image->channels == 3);
    struct decoder d;
    ORL_TRY(orl_image_init(log, out, image->width, image->height, 4, ORL_PIXEL_F32));
    init_decoder(response, image, &d);
    *white = d.white;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            decode_pixel(&d, image, x, y, out->f32 + 4 * ((size_t)y * (size_t)image->width + (size_t)x));
    return ORL_OK;
}
