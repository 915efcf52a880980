// A photograph sees a point or does not: Airieau 2012, 5.2.
#include "gather/hidden.glsl"

float visible_surface(photo shot, vec4 seen, float z)
{
    return photo_sees(seen, z) ? 1.0 : 0.0;
}

float visible_guess(photo shot, vec4 seen, float z)
{
    return photo_unhidden(seen, z) ? 1.0 : 0.0;
}
