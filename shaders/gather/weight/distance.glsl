// 1 / (1 + delta), where delta is the difference of distances: Airieau 2012, section 4, resolution.
// The paper's delta has the scene's unit; here it is relative to the viewing distance.

float weight_of(photo source, Point at)
{
    float view_distance = length(at.p);
    return 1.0 / (1.0 + abs(view_distance - length(source.eye.xyz - at.p)) / view_distance);
}

// Weight of a photograph that is nearer or farther by a tenth of the viewing distance.
float weight_unit(bool guessed)
{
    return 1.0 / 1.1;
}
