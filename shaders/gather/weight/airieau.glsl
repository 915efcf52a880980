// Airieau 2012, 5.3: cos(theta) / delta, with delta relative to the viewing distance and kept
// from zero, so that the weight has no unit and no pole.

// Where depth is only guessed, photographs disagree: let the best one dominate.
const float GUESS_POWER = 8.0;
// Powers of weights by differences of distance from none to all of the distance stay floats.
const float GUESS_SCALE = 0.03;

float weight_of(photo shot, Point at)
{
    vec3 to_photo = shot.eye.xyz - at.p;
    float view_distance = length(at.p), photo_distance = length(to_photo);
    float cosine = dot(-at.p, to_photo) / (view_distance * photo_distance);
    float delta = abs(view_distance - photo_distance) / view_distance + opt.distance_floor;
    float weight = max(cosine, 0.0) / delta;
    return at.guessed ? pow(weight * GUESS_SCALE, GUESS_POWER) : weight;
}

// Of a photograph a tenth of the distance nearer or farther.
float weight_unit(bool guessed)
{
    float unit = 1.0 / (0.1 + opt.distance_floor);
    return guessed ? pow(unit * GUESS_SCALE, GUESS_POWER) : unit;
}
