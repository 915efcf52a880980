// The plane of least cost of an open cell, for the renderer and for the page.
#include "guess/planes.glsl"

// Share of the estimate's inverse depth; sums: of the costs of the paths that end at each plane.
float picked_share(float sums[PLANES])
{
    float least = sums[0];
    int best = 0;
    for (int k = 1; k < PLANES; k++) {
        best = sums[k] < least ? k : best;
        least = min(least, sums[k]);
    }
    return plane_share(best);
}
