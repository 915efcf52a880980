#include <math.h>

#include "oriel/scene.h"

static const double APART_EV = 1.5, LEAST_SHARE = 0.1;

// Photographs that are not held out, of one series or, below 0, of all.
static size_t count(const struct orl_scene *scene, int series)
{
    size_t n = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        n += !scene->photos[i].test && (series < 0 || scene->photos[i].series == series);
    return n;
}

bool orl_scene_is_bracketed(const struct orl_scene *scene)
{
    double low = INFINITY, high = -INFINITY, all = (double)count(scene, -1);
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_photo *photo = &scene->photos[i];
        double of_series = (double)count(scene, photo->series);
        if (photo->test || of_series < 2 || of_series < LEAST_SHARE * all)
            continue;
        low = fmin(low, photo->exposure_ev);
        high = fmax(high, photo->exposure_ev);
    }
    return high - low >= APART_EV;
}
