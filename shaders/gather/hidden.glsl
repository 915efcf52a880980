// What a photograph's own depth says of a surface point: is it seen, or hidden, and how surely?
#include "gather/photo.glsl"

// Does one of the four texels around agree with z? All four are compared, so that slanted surfaces
// match themselves.
bool photo_agrees(vec4 seen, float z)
{
    return any(lessThanEqual(abs(seen - z), vec4(opt.depth_tolerance * z)));
}

// Has the photograph no depth there, or an estimate only?
bool photo_knows_nothing(vec4 seen)
{
    return all(lessThanEqual(seen, vec4(0.0)));
}

// Does none of these depths lie clearly in front of z? For points only known to be
// behind everything else.
bool photo_unhidden(vec4 seen, float z)
{
    float nearest = z - opt.depth_tolerance * z;
    return !any(bvec4(seen.x > 0.0 && seen.x < nearest, seen.y > 0.0 && seen.y < nearest,
                      seen.z > 0.0 && seen.z < nearest, seen.w > 0.0 && seen.w < nearest));
}

// How surely the photograph saw this surface: 1 where its depth agrees, little where it
// has none, 0 where it saw something else.
float photo_seen_share(vec4 seen, float z)
{
    vec4 off = abs(seen - z) * (1.0 / (z * opt.depth_tolerance));
    vec4 share = clamp(2.0 - off, 0.0, 1.0);
    float agrees = max(max(share.x, share.y), max(share.z, share.w));
    bool unknown = all(lessThanEqual(seen, vec4(0.0)));
    return unknown ? opt.unknown_trust : agrees;
}

// Radians of parallax between the view and the photograph by which what is hidden lies behind a
// guess in a hole of the photograph's depth. In angles, since guesses of what is far are rough,
// and a photograph taken from beside the view shows the same hole in the same place.
const float GUESS_PARALLAX = 0.05;

// How much of the photograph around a pixel has nothing standing before z.
float photo_unhidden_share(photo shot, vec4 seen, float z)
{
    vec4 front = (z - seen) * (1.0 / (z * opt.depth_tolerance)); // in tolerances
    vec4 nearer = -1.0 / min(seen, -1e-9) - 1.0 / z;
    vec4 behind_guess = nearer * (length(shot.eye.xyz) / GUESS_PARALLAX);
    front = mix(front, behind_guess, lessThan(seen, vec4(0.0)));
    vec4 share = mix(clamp(2.0 - front, 0.0, 1.0), vec4(1.0), equal(seen, vec4(0.0)));
    return dot(share, vec4(0.25)); // at an edge it shows some of what is behind
}
