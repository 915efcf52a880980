// One over 1 + delta, delta being the difference of distances: Airieau 2012, section 4, resolution.
// The paper's delta has the scene's unit; here it is relative to the viewing distance.

float weight_of(photo shot, Point at)
{
    float view_distance = length(at.p);
    return 1.0 / (1.0 + abs(view_distance - length(shot.eye.xyz - at.p)) / view_distance);
}

// Of a photograph a tenth of the distance nearer or farther.
float weight_unit(bool guessed)
{
    return 1.0 / 1.1;
}
