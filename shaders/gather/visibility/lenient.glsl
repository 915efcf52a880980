// As hard, but a photograph without depth at the point is accepted.
#include "gather/hidden.glsl"

float visible_surface(photo source, Point at, vec4 seen, float z)
{
    return photo_agrees(seen, z) || photo_knows_nothing(seen) ? 1.0 : 0.0;
}

float visible_guess(photo source, Point at, vec4 seen, float z)
{
    return photo_unhidden(seen, z) ? 1.0 : 0.0;
}
