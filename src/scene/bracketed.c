#include <math.h>

#include "oriel/scene.h"

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
