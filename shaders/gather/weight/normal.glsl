// The cosine between the surface's normal and the photograph's line of sight: Orzan 2005, 4.4.2.

float weight_of(photo source, Point at)
{
    return max(dot(at.normal, normalize(source.eye.xyz - at.p)), 0.0);
}

// Weight of a photograph whose line of sight is a tenth of a radian from the normal.
float weight_unit(bool guessed)
{
    return cos(0.1);
}
