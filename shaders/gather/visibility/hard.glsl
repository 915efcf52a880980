// A photograph sees a point if its depth map agrees: the shadow test of Airieau 2012, 5.2. It is
// rejected where it has no depth.
#include "gather/hidden.glsl"

float visible_surface(photo source, Point at, vec4 seen, float z)
{
    return photo_agrees(seen, z) ? 1.0 : 0.0;
}

float visible_guess(photo source, Point at, vec4 seen, float z)
{
    return photo_unhidden(seen, z) ? 1.0 : 0.0;
}
