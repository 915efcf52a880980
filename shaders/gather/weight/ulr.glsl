// Unstructured lumigraph as SIBR's ulrv2 has it (Buehler 2001, 4.2): one over the angle between the
// two lines of sight and a tenth of how much farther away the photograph was taken.

float weight_of(photo shot, Point at)
{
    vec3 to_photo = shot.eye.xyz - at.p;
    float here = length(at.p), there = length(to_photo);
    float angle = acos(clamp(dot(-at.p, to_photo) / (here * there), -1.0, 1.0));
    return 1.0 / (angle + 0.1 * max((there - here) / there, 1e-4));
}

// Of a photograph a tenth of a radian away.
float weight_unit(bool guessed)
{
    return 10.0;
}
