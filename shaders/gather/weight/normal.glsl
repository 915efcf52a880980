// The cosine between the surface's normal and the line of sight of the photograph: Orzan 2005, 4.4.2.

float weight_of(photo shot, Point at)
{
    return max(dot(at.normal, normalize(shot.eye.xyz - at.p)), 0.0);
}

// Of a photograph a tenth of a radian from the normal.
float weight_unit(bool guessed)
{
    return cos(0.1);
}
