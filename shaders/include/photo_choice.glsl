// How well a photograph can paint a surface point, shared by the passes of method oriel.
#include "include/photo.glsl"

// Unstructured lumigraph penalty (Buehler 2001, 4.2; resolution as in SIBR's ulr): the angle
// between the two lines of sight, and how much coarser the photograph sees the point. The
// constant keeps a photograph taken from here from silencing every other.
float photo_penalty(photo shot, vec3 p)
{
    vec3 to_photo = shot.eye.xyz - p;
    float here = length(p), there = length(to_photo);
    float angle = acos(clamp(dot(-p, to_photo) / (here * there), -1.0, 1.0));
    // Compare sizes of a pixel on the surface, not distances: focal lengths may differ.
    float coarser = there / here * view_focal.x / shot.focal.x - 1.0;
    return angle + 0.1 * max(coarser, 0.0) + 0.005;
}

// Of depth, as options.x: what is twice this behind a guess in a hole of the photograph's depth is
// hidden there. Guesses on both sides are rough: a fountain hides the facade across the
// square, and one house not the next.
const float GUESS_TOLERANCE = 0.33;

// How much of the photograph around a pixel has nothing standing before z.
float photo_unhidden_share(vec4 seen, float z)
{
    vec4 front = (z - seen) / (z * options.x); // in tolerances
    vec4 behind_guess = (z + seen) / (z * GUESS_TOLERANCE);
    front = mix(front, behind_guess, lessThan(seen, vec4(0.0)));
    vec4 share = mix(clamp(2.0 - front, 0.0, 1.0), vec4(1.0), equal(seen, vec4(0.0)));
    return dot(share, vec4(0.25)); // at an edge it shows some of what is behind
}
