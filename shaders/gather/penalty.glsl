// Penalties of a photograph for a surface point: how far it is from the view's own line of sight.
#include "gather/photo.glsl"
#include "shared/penalty.h"

float photo_penalty(photo source, vec3 p)
{
    vec3 to_photo = source.eye.xyz - p;
    float here = length(p), there = length(to_photo);
    float angle = acos(clamp(dot(-p, to_photo) / (here * there), -1.0, 1.0));
    // Compares the sizes of a pixel on the surface rather than distances: focal lengths may differ.
    float coarser = there / here * (view_focal.x / source.focal.x) - 1.0;
    return ORL_PENALTY(angle, coarser);
}

// On known surfaces, penalties below about this many radians differ little, in proportion to their
// squares. Otherwise, one photograph would flash up and vanish when the viewer passes its position.
const float SURFACE_PENALTY = 0.3;

float photo_surface_penalty(float penalty)
{
    return length(vec2(penalty, SURFACE_PENALTY));
}

// A photograph with this penalty, an angle of about 50 degrees, shows other sides of objects. Where the depth is
// only estimated, it counts GUESS_FAR, so that it paints what no other photograph shows.
const float GUESS_PENALTY_MAX = 0.9, GUESS_FAR = 0.1;

// Falls from 1 to GUESS_FAR towards GUESS_PENALTY_MAX.
float photo_beside(float penalty)
{
    return clamp(3.0 * (1.0 - penalty / GUESS_PENALTY_MAX), GUESS_FAR, 1.0);
}

// Weight of a photograph where the depth is only estimated: 1 in its middle, 0.7 at its border (feathering, Szeliski
// 2006, 6.2). Photographs differ in what they show there, so the border of one would be seen as a line.
float photo_feather(photo source, vec2 pixel)
{
    vec2 side = min(pixel, source.size.xy - pixel) / source.size.xy;
    return 0.7 + 0.6 * min(side.x, side.y);
}
