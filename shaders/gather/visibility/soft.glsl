// Continuous visibility, so that no photograph appears suddenly when the viewer moves.
#include "gather/hidden.glsl"

float visible_surface(photo source, Point at, vec4 seen, float z)
{
    return photo_seen_share(seen, z);
}

float visible_guess(photo source, Point at, vec4 seen, float z)
{
    return photo_unhidden_share(source, seen, z);
}
