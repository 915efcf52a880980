#include "scene/meter.h"

#include <math.h>

#include "core/color.h"

// Standard deviation of the weight, as a share of each side.
static const double METER_SPREAD = 0.25;
static const double METER_BLACK = 1.0 / 65536;

float orl_light_aligned(float gain, float value)
{
    float third = fminf(gain - 1, 0.5f);
    return gain * value / (1 + value * (gain - 1 - third + third * value * value));
}

double orl_squared_radius(const struct orl_camera *camera, double x, double y)
{
    double dx = x - camera->cx, dy = y - camera->cy;
    double half2 = 0.25 * ((double)camera->width * camera->width + (double)camera->height * camera->height);
    return (dx * dx + dy * dy) / half2;
}

float orl_illumination(const float vignette[3], const struct orl_camera *camera, double x,
                       double y)
{
    double r2 = orl_squared_radius(camera, x, y);
    double light = 1 + r2 * ((double)vignette[0] + r2 * ((double)vignette[1] + r2 * (double)vignette[2]));
    return fmaxf((float)light, 0.1f);
}

void orl_meter_add(struct orl_meter *meter, const float rgb[3], double x, double y, int width,
                   int height)
{
    const float seen[3] = {fminf(rgb[0], 1), fminf(rgb[1], 1), fminf(rgb[2], 1)};
    double dx = (x / width - 0.5) / METER_SPREAD, dy = (y / height - 0.5) / METER_SPREAD;
    double weight = exp(-0.5 * (dx * dx + dy * dy));
    meter->light += weight * (double)orl_luminance(seen);
    meter->weight += weight;
}

double orl_meter_log2(const struct orl_meter *meter)
{
    double mean = meter->weight > 0 ? meter->light / meter->weight : 0;
    return log2(mean > METER_BLACK ? mean : METER_BLACK);
}

double orl_picture_metered(const struct orl_image *color)
{
    struct orl_meter meter = {0};
    for (int y = 0; y < color->height; y++)
        for (int x = 0; x < color->width; x++)
            orl_meter_add(&meter,
                          color->f32 + 3 * ((size_t)y * (size_t)color->width + (size_t)x),
                          x + 0.5, y + 0.5, color->width, color->height);
    return orl_meter_log2(&meter);
}

// --- the light that a scene is shown in ---

enum orl_result orl_scene_set_light(const struct orl_log *log, struct orl_scene *scene,
                                    const char *photo)
{
    if (!photo)
        return ORL_OK;
    int index = orl_scene_find_photo(scene, photo);
    if (index < 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--light %s: there is no such photograph", photo);
    if (scene->photos[index].test)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--light %s: this photograph is held out", photo);
    float light[3];
    for (int c = 0; c < 3; c++)
        light[c] = scene->photos[index].gain[c];
    // Renderings become darker by this, and what meters them follows.
    float darker_ev = log2f(orl_luminance(light));
    for (size_t i = 0; i < scene->photo_count; i++) {
        for (int c = 0; c < 3; c++)
            scene->photos[i].gain[c] /= light[c];
        scene->photos[i].metered_ev -= darker_ev;
    }
    return ORL_OK;
}

// --- exposures on purpose ---

static const double APART_EV = 1.5, LEAST_SHARE = 0.1;

// Photographs that are not held out, of one series or, below 0, of all. *mean_ev: their mean exposure.
static size_t count(const struct orl_scene *scene, int series, double *mean_ev)
{
    size_t n = 0;
    *mean_ev = 0;
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_photo *photo = &scene->photos[i];
        if (photo->test || (series >= 0 && photo->series != series))
            continue;
        n++;
        *mean_ev += (photo->exposure_ev - *mean_ev) / (double)n;
    }
    return n;
}

bool orl_scene_is_bracketed(const struct orl_scene *scene)
{
    double low = INFINITY, high = -INFINITY, mean, all = (double)count(scene, -1, &mean);
    for (size_t i = 0; i < scene->photo_count; i++) {
        double of_series = (double)count(scene, scene->photos[i].series, &mean);
        if (of_series < 2 || of_series < LEAST_SHARE * all)
            continue;
        low = fmin(low, mean);
        high = fmax(high, mean);
    }
    return high - low >= APART_EV;
}
