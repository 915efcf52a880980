// Which photographs see a surface point, and their weights, as Airieau 2012 has them.
#include "gather/photo.glsl"

// Shadow test (Airieau 2012, 5.2) against the four texels around the projection, so
// that slanted surfaces match themselves. Photographs without depth there pass.
bool photo_sees(vec4 seen, float z, bool guessed)
{
    float tolerance = options.x * z;
    if (guessed)
        return photo_unhidden(seen, z, tolerance);
    return any(lessThanEqual(abs(seen - z), vec4(tolerance))) ||
           all(lessThanEqual(seen, vec4(0.0)));
}

// Airieau 2012, 5.3: cos(theta) / delta, with delta relative to the viewing
// distance and kept from zero, so that the weight has no unit and no pole.
float airieau_weight(vec3 p, vec3 eye)
{
    vec3 to_photo = eye - p;
    float view_distance = length(p), photo_distance = length(to_photo);
    float cosine = dot(-p, to_photo) / (view_distance * photo_distance);
    float delta = abs(view_distance - photo_distance) / view_distance + options.y;
    return max(cosine, 0.0) / delta;
}
