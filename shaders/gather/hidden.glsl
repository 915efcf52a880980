// Visibility of a surface point in a photograph, from the photograph's depth map.
#include "gather/photo.glsl"

// True if one of the four texels around agrees with z. With all four, slanted surfaces match
// themselves.
bool photo_agrees(vec4 seen, float z)
{
    return any(lessThanEqual(abs(seen - z), vec4(opt.depth_tolerance * z)));
}

// True if none of these depths lies clearly in front of z. For estimated background depth, which
// only says that the point is behind everything else.
bool photo_unhidden(vec4 seen, float z)
{
    float nearest = z - opt.depth_tolerance * z;
    return !any(bvec4(seen.x > 0.0 && seen.x < nearest, seen.y > 0.0 && seen.y < nearest,
                      seen.z > 0.0 && seen.z < nearest, seen.w > 0.0 && seen.w < nearest));
}

// Probability that the photograph saw this surface: 1 where its depth agrees or it has none, 0 where it saw another
// surface.
float photo_seen_share(vec4 seen, float z)
{
    vec4 off = abs(seen - z) * (1.0 / (z * opt.depth_tolerance));
    vec4 share = clamp(2.0 - off, 0.0, 1.0);
    float agrees = max(max(share.x, share.y), max(share.z, share.w));
    bool unknown = all(lessThanEqual(seen, vec4(0.0)));
    return unknown ? 1.0 : agrees;
}

// Parallax between the view and the photograph, in radians, from which a point behind the estimated
// depth in a hole of the depth map counts as occluded. It is an angle, since estimates of far
// depths are rough and a photograph taken close to the view shows the same hole in the same place.
const float GUESS_PARALLAX = 0.05;

// Share of the four texels around a pixel that have no occluder in front of z.
float photo_unhidden_share(photo source, vec4 seen, float z)
{
    vec4 front = (z - seen) * (1.0 / (z * opt.depth_tolerance)); // in units of the depth tolerance
    vec4 nearer = -1.0 / min(seen, -1e-9) - 1.0 / z;
    vec4 behind_guess = nearer * (length(source.eye.xyz) / GUESS_PARALLAX);
    front = mix(front, behind_guess, lessThan(seen, vec4(0.0)));
    vec4 share = mix(clamp(2.0 - front, 0.0, 1.0), vec4(1.0), equal(seen, vec4(0.0)));
    return dot(share, vec4(0.25)); // at a depth edge the background is visible in part
}
