#include "render/radiance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

// IEC 61966-2-1.
static float srgb_decode(int value)
{
    float c = (float)value / 255;
    return c <= 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
}

// The linear exposure of every 8-bit value, and the step from one to the next.
struct decoder {
    float linear[3][256], step[3][256];
};

static void make_decoder(const struct orl_photo_response *response, struct decoder *d)
{
    for (int c = 0; c < 3; c++) {
        for (int v = 0; v < 256; v++)
            d->linear[c][v] = response->linear ? response->linear[c][v] : srgb_decode(v);
        for (int v = 0; v < 256; v++) {
            int below = v > 0 ? v - 1 : 0, above = v < 255 ? v + 1 : 255;
            d->step[c][v] = fabsf(d->linear[c][above] - d->linear[c][below]) /
                            (float)(above - below);
        }
    }
}

// --- trust ---

// Expected squared relative error, mean of the channels: that of log radiance too.
static double relative_variance(const struct orl_photo_response *response, const float x[3],
                                const float slope[3])
{
    const struct orl_sensor *s = response->sensor;
    // Below the noise of the scene's brightest photograph all is one darkness. So the same
    // darkness is measured worst by the darkest photograph.
    double brighter = exp2((double)(response->ev - response->ev_brightest));
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        double rounding = (double)slope[c] * (double)slope[c] / 12;
        double dark = s->read * s->read + rounding;
        double level = fmax((double)x[c], sqrt(dark) * brighter);
        sum += (s->shot * fmax((double)x[c], 0) + dark) / (level * level);
    }
    return sum / 3;
}

float orl_trust(const struct orl_photo_response *response, const float x[3],
                const float slope[3], float peak)
{
    const struct orl_sensor *s = response->sensor;
    double model = s->model * s->model;
    double trust = model / (model + relative_variance(response, x, slope));
    trust = fmax(trust, (double)ORL_TRUST_MIN);
    if (!response->clips)
        return (float)trust;
    double over = ((double)peak - s->soft) / (s->hard - s->soft);
    over = over < 0 ? 0 : over > 1 ? 1 : over;
    double fall = 1 - over * over * (3 - 2 * over);
    // White says "at least this": most in the darkest photograph.
    double bound = 0x1p-10 * exp2(-2 * (double)(response->ev - response->ev_darkest));
    bound = fmax(fmin(bound, trust), (double)ORL_TRUST_MIN);
    return (float)(bound + (trust - bound) * fall);
}

// --- whole photographs ---

// Largest channel of each pixel of a row.
static void row_peaks(const struct orl_image *image, const struct decoder *d, int y, float *peaks)
{
    size_t width = (size_t)image->width;
    for (size_t x = 0; x < width; x++) {
        size_t at = 3 * ((size_t)y * width + x);
        float peak = 0;
        for (size_t c = 0; c < 3; c++) {
            float value = image->type == ORL_PIXEL_U8 ? d->linear[c][image->u8[at + c]]
                                                      : image->f32[at + c];
            peak = fmaxf(peak, value);
        }
        peaks[x] = peak;
    }
}

// Relative illumination at a squared distance from the centre, in half diagonals.
static float light_at(const float vignette[3], float r2)
{
    return fmaxf(1 + r2 * (vignette[0] + r2 * (vignette[1] + r2 * vignette[2])), 0.05f);
}

// peaks: of the rows above, here and below. A pixel beside a clipped one holds some of it:
// lenses, Bayer patterns, JPEG and resampling have all mixed them.
static void decode_row(const struct orl_photo_response *response, const struct decoder *d,
                       const struct orl_image *image, int y, float *const peaks[3], float *out)
{
    static const float exact[3] = {0};
    int width = image->width;
    float half[2] = {0.5f * (float)width, 0.5f * (float)image->height};
    float scale = 1 / (half[0] * half[0] + half[1] * half[1]);
    float dy = (float)y + 0.5f - response->centre[1];
    for (int x = 0; x < width; x++) {
        size_t at = 3 * ((size_t)y * (size_t)width + (size_t)x);
        int left = x > 0 ? x - 1 : 0, right = x < width - 1 ? x + 1 : x;
        float peak = 0, value[3], slope[3];
        for (int i = left; i <= right; i++)
            peak = fmaxf(peak, fmaxf(peaks[0][i], fmaxf(peaks[1][i], peaks[2][i])));
        for (size_t c = 0; c < 3; c++) {
            int v = image->type == ORL_PIXEL_U8 ? image->u8[at + c] : 0;
            value[c] = image->type == ORL_PIXEL_U8 ? d->linear[c][v] : image->f32[at + c];
            slope[c] = image->type == ORL_PIXEL_U8 ? d->step[c][v] : exact[c];
        }
        float trust = orl_trust(response, value, slope, peak);
        float dx = (float)x + 0.5f - response->centre[0];
        float share = trust / light_at(response->vignette, (dx * dx + dy * dy) * scale);
        for (size_t c = 0; c < 3; c++)
            out[4 * (size_t)x + c] = value[c] * share;
        out[4 * (size_t)x + 3] = trust;
    }
}

enum orl_result orl_radiance_decode(const struct orl_log *log,
                                    const struct orl_photo_response *response,
                                    const struct orl_image *image, struct orl_image *out)
{
    memset(out, 0, sizeof *out);
    ORL_REQUIRE(log, image->channels == 3);
    size_t width = (size_t)image->width;
    struct decoder *decoder = orl_array(log, 1, sizeof *decoder);
    float *rows = orl_array(log, 3 * width, sizeof *rows);
    enum orl_result result = decoder && rows ? orl_image_init(log, out, image->width,
                                                              image->height, 4, ORL_PIXEL_F32)
                                             : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        make_decoder(response, decoder);
        float *peaks[3] = {rows, rows + width, rows + 2 * width};
        row_peaks(image, decoder, 0, peaks[1]);
        memcpy(peaks[0], peaks[1], width * sizeof *rows);
        for (int y = 0; y < image->height; y++) {
            row_peaks(image, decoder, y + 1 < image->height ? y + 1 : y, peaks[2]);
            decode_row(response, decoder, image, y, peaks, out->f32 + 4 * width * (size_t)y);
            float *above = peaks[0];
            peaks[0] = peaks[1];
            peaks[1] = peaks[2];
            peaks[2] = above;
        }
    }
    free(decoder);
    free(rows);
    return result;
}
