// Visibility for radiance. It replaces the visibility of every method but those with `none`.
#include "gather/hidden.glsl"

// How far a photograph is trusted that has no depth where the surface would be.
const float UNKNOWN_TRUST = 0.5;

// Squared share of a sample that shows the surface at z. It is squared since an occluder may be a
// thousand times as bright.
float visible_surface(photo source, Point at, vec4 seen, float z)
{
    vec4 same = clamp(2.0 - abs(seen - z) / (z * opt.depth_tolerance), 0.0, 1.0);
    float share = dot(mix(same, vec4(UNKNOWN_TRUST), lessThanEqual(seen, vec4(0.0))), vec4(0.25));
    return share * share;
}

float visible_guess(photo source, Point at, vec4 seen, float z)
{
    return photo_unhidden_share(source, seen, z);
}
