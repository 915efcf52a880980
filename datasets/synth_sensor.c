// Turns radiance into the photograph that a camera would take of it.
#include <math.h>
#include <string.h>

#include "datasets/synth.h"

static double clamp01(double v)
{
    return v <= 0 ? 0 : v >= 1 ? 1 : v;
}

// Share of the contrast curve 3 v^2 - 2 v^3 in the film response.
static const double FILM_CONTRAST = 0.5;

double orl_synth_encode(enum orl_synth_response response, double light)
{
    double v = clamp01(light);
    v = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
    if (response == ORL_SYNTH_FILM)
        v += FILM_CONTRAST * (v * v * (3 - 2 * v) - v);
    return v;
}

double orl_synth_decode(enum orl_synth_response response, double value)
{
    double target = clamp01(value), v = target;
    // The slope of the contrast curve is between 0.5 and 1.25, so that Newton's method converges.
    for (int i = 0; response == ORL_SYNTH_FILM && i < 20; i++) {
        double f = v + FILM_CONTRAST * (v * v * (3 - 2 * v) - v) - target;
        v = clamp01(v - f / (1 + FILM_CONTRAST * (6 * v * (1 - v) - 1)));
    }
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

const char *orl_synth_response_name(enum orl_synth_response response)
{
    static const char *const names[] = {ORL_SYNTH_RESPONSES(ORL_ENUM_NAME)};
    return names[response];
}

static uint32_t next_word(uint32_t *state)
{
    // PCG-RXS-M-XS (O'Neill 2014).
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (word >> 22) ^ word;
}

// An approximately normal deviate: the sum of four uniform ones, with variance 1.
static double next_normal(uint32_t *state)
{
    double sum = 0;
    for (int i = 0; i < 4; i++)
        sum += next_word(state) * 0x1p-32 - 0.5;
    return sum * sqrt(3.0);
}

struct orl_synth_sensor orl_synth_sensor(const struct orl_synth_params *params, int index)
{
    struct orl_synth_sensor sensor = {
        .exposure_ev =
            params->exposure_count ? params->exposures_ev[index % params->exposure_count] : 0,
        .vignette = params->vignette,
        .noise = params->noise,
        .key = params->seed + (uint32_t)index * 7919u,
        .response = params->response,
    };
    uint32_t state = sensor.key ^ 0x5bd1e995u;
    double all = next_word(&state) * 0x1p-31 - 1;
    for (int c = 0; c < 3; c++)
        sensor.drift_ev[c] = params->drift_ev * (all + 0.25 * (next_word(&state) * 0x1p-31 - 1));
    return sensor;
}

enum orl_result orl_synth_expose(const struct orl_log *log, const struct orl_image *radiance,
                                 const struct orl_synth_sensor *sensor, struct orl_image *photo)
{
    memset(photo, 0, sizeof *photo);
    ORL_REQUIRE(log, radiance->type == ORL_PIXEL_F32 && radiance->channels == 3);
    ORL_TRY(orl_image_init(log, photo, radiance->width, radiance->height, 3, ORL_PIXEL_U8));
    double scale[3];
    for (int c = 0; c < 3; c++)
        scale[c] = exp2(sensor->exposure_ev + sensor->drift_ev[c]);
    double cx = 0.5 * radiance->width, cy = 0.5 * radiance->height;
    uint32_t state = sensor->key * 0x9e3779b9u;
    size_t i = 0;
    for (int y = 0; y < radiance->height; y++) {
        for (int x = 0; x < radiance->width; x++) {
            double dx = x + 0.5 - cx, dy = y + 0.5 - cy;
            double r2 = (dx * dx + dy * dy) / (cx * cx + cy * cy);
            for (int c = 0; c < 3; c++, i++) {
                double v = scale[c] * (1 - sensor->vignette * r2) * radiance->f32[i];
                if (sensor->noise > 0) // shot noise grows with light; read noise is constant
                    v += sensor->noise * sqrt(fmin(v, 1) + 0.0004) * next_normal(&state);
                photo->u8[i] = (uint8_t)(255 * orl_synth_encode(sensor->response, v) + 0.5);
            }
        }
    }
    return ORL_OK;
}
