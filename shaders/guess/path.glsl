// Semi-global matching (Hirschmueller 2008, equation 13, with one penalty for steps of any size), for the renderer and
// for the page: the least cost of a path of open cells that ends at a cell and a plane.
#include "guess/planes.glsl"

const float STEP = 0.4; // cost of a step to another plane

// Takes a path on to a cell with these costs of its planes. path: its least cost at each plane; least: of
// all planes. Behind a closed cell it begins anew.
void path_step(float costs[PLANES], inout float path[PLANES], inout float least)
{
    float next = 1e30;
    bool closed = costs[0] == CLOSED;
    for (int k = 0; k < PLANES; k++) {
        path[k] = closed ? 0.0 : costs[k] + min(path[k] - least, STEP);
        next = min(next, path[k]);
    }
    least = next;
}
