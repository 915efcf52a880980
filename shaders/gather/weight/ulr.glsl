// Weight of the unstructured lumigraph as in SIBR's ulrv2 (Buehler 2001, 4.2): the inverse of the
// angle between the two lines of sight plus a tenth of the relative resolution penalty.

float weight_of(photo source, Point at)
{
    vec3 to_photo = source.eye.xyz - at.p;
    float here = length(at.p), there = length(to_photo);
    float angle = acos(clamp(dot(-at.p, to_photo) / (here * there), -1.0, 1.0));
    return 1.0 / (angle + 0.1 * max((there - here) / there, 1e-4));
}

// Weight of a photograph at an angle of a tenth of a radian.
float weight_unit(bool guessed)
{
    return 10.0;
}
