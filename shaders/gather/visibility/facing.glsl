// A photograph sees every surface that faces it, occluded or not: Orzan 2005, 4.4.1. The normal is
// that of the surface at the pixel instead of the triangle's.

float visible_surface(photo source, Point at, vec4 seen, float z)
{
    return dot(at.normal, at.p - source.eye.xyz) < 0.0 ? 1.0 : 0.0;
}

float visible_guess(photo source, Point at, vec4 seen, float z)
{
    return 1.0;
}
