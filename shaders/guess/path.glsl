// Semi-global matching (Hirschmueller 2008, equation 13), for the renderer and for the page: the least
// cost of a path of open cells that ends at a cell and a plane.
#include "guess/planes.glsl"

// Cost of a step to the next plane, and of a greater one.
const float STEP = 0.05, JUMP = 0.4;

// Takes a path on to a cell with these costs of its planes. path: its least cost at each plane; least: of
// all planes. Behind a closed cell it begins anew.
void path_step(float costs[PLANES], inout float path[PLANES], inout float least)
{
    float before[PLANES] = path, next = 1e30;
    bool closed = costs[0] == CLOSED;
    for (int k = 0; k < PLANES; k++) {
        float best = min(min(before[k], least + JUMP),
                         min(before[max(k - 1, 0)], before[min(k + 1, PLANES - 1)]) + STEP);
        path[k] = closed ? 0.0 : costs[k] + best - least;
        next = min(next, path[k]);
    }
    least = next;
}
