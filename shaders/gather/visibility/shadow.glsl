// A photograph sees a surface that faces it and agrees with its shadow map: Orzan 2005, 4.5.1.
#include "gather/hidden.glsl"

float visible_surface(photo source, Point at, vec4 seen, float z)
{
    bool faces = dot(at.normal, at.p - source.eye.xyz) < 0.0;
    return faces && photo_agrees(seen, z) ? 1.0 : 0.0;
}

float visible_guess(photo source, Point at, vec4 seen, float z)
{
    return photo_unhidden(seen, z) ? 1.0 : 0.0;
}
