// Weight of Airieau 2012, equation 5.3: cos(theta) / delta. Here delta is relative to the viewing
// distance and bounded away from zero, so that the weight has no unit and no pole.

// On estimated background depth the photographs disagree: the best one dominates.
const float GUESS_POWER = 8.0;
// Scale of a weight before it is raised to GUESS_POWER, so that the power fits a float.
const float GUESS_SCALE = 0.03;

// Keeps the difference of distances away from zero.
const float DISTANCE_FLOOR = 1e-6;

float weight_of(photo source, Point at)
{
    vec3 to_photo = source.eye.xyz - at.p;
    float view_distance = length(at.p), photo_distance = length(to_photo);
    float cosine = dot(-at.p, to_photo) / (view_distance * photo_distance);
    float delta = abs(view_distance - photo_distance) / view_distance + DISTANCE_FLOOR;
    float weight = max(cosine, 0.0) / delta;
    return at.guessed ? pow(weight * GUESS_SCALE, GUESS_POWER) : weight;
}

// Weight of a photograph that is nearer or farther by a tenth of the viewing distance.
float weight_unit(bool guessed)
{
    float unit = 1.0 / (0.1 + DISTANCE_FLOOR);
    return guessed ? pow(unit * GUESS_SCALE, GUESS_POWER) : unit;
}
