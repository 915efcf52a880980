// The cosine of the angle between the two lines of sight: Airieau 2012, section 4, epipolar
// consistency.

float weight_of(photo source, Point at)
{
    return max(dot(normalize(-at.p), normalize(source.eye.xyz - at.p)), 0.0);
}

// Weight of a photograph at an angle of a tenth of a radian.
float weight_unit(bool guessed)
{
    return cos(0.1);
}
