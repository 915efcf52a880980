// The plane of least cost of an open cell, between planes by a parabola, if it costs clearly less than the
// estimate; for the renderer and for the page.
#include "guess/planes.glsl"

// Least gain, of the sum over four directions.
const float CLEARLY = 0.3;

// Share of the estimate's inverse depth; sums: of the costs of the paths that end at each plane.
float picked_share(float sums[PLANES])
{
    float least = sums[0], before = 0.0, after = 0.0;
    int best = 0;
    for (int k = 1; k < PLANES; k++) {
        bool less = sums[k] < least;
        best = less ? k : best;
        before = less ? sums[k - 1] : before;
        after = less ? sums[min(k + 1, PLANES - 1)] : after;
        least = less ? sums[k] : least;
    }
    float bend = before + after - 2.0 * least;
    bool between = best > 0 && best < PLANES - 1 && bend > 0.0;
    float off = between ? 0.5 * (before - after) / bend : 0.0;
    return sums[0] - least > CLEARLY ? plane_share(float(best) + off) : 1.0;
}
