// Continuous visibility, so that no photograph appears suddenly when the viewer moves.
#include "gather/hidden.glsl"

float visible_surface(photo shot, Point at, vec4 seen, float z)
{
    return photo_seen_share(seen, z);
}

float visible_guess(photo shot, Point at, vec4 seen, float z)
{
    return photo_unhidden_share(shot, seen, z);
}
