// How well a photograph can paint a surface point.
#include "gather/photo.glsl"
#include "shared/penalty.h"

float photo_penalty(photo shot, vec3 p)
{
    vec3 to_photo = shot.eye.xyz - p;
    float here = length(p), there = length(to_photo);
    float angle = acos(clamp(dot(-p, to_photo) / (here * there), -1.0, 1.0));
    // Compare sizes of a pixel on the surface, not distances: focal lengths may differ.
    float coarser = there / here * (view_focal.x / shot.focal.x) - 1.0;
    return ORL_PENALTY(angle, coarser);
}

// On known surfaces small penalties, up to about this many radians, differ little, and in proportion
// to their squares: a viewer who walks past a photograph's place would else see it, and it alone,
// flash up and go.
const float SURFACE_PENALTY = 0.3;

float photo_surface_penalty(float penalty)
{
    return length(vec2(penalty, SURFACE_PENALTY));
}

// A photograph with so great a penalty, an angle of some 50 degrees, shows another side of things:
// no help where depth is guessed.
const float GUESS_PENALTY_MOST = 0.9;

// From 1 to 0 there.
float photo_beside(float penalty)
{
    return clamp(3.0 * (1.0 - penalty / GUESS_PENALTY_MOST), 0.0, 1.0);
}
