#include "preprocess/expose/bracketing.h"

// The slope is by least squares.
bool orl_exposures_are_metered(const double *ev, const double *light, size_t count)
{
    double mean_ev = 0, mean_light = 0, spread = 0, both = 0;
    for (size_t i = 0; i < count; i++) {
        mean_ev += ev[i] / (double)count;
        mean_light += light[i] / (double)count;
    }
    for (size_t i = 0; i < count; i++) {
        spread += (ev[i] - mean_ev) * (ev[i] - mean_ev);
        both += (ev[i] - mean_ev) * (light[i] - mean_light);
    }
    return 4 * both < spread;
}
