// How well a photograph can paint a surface point, shared by the passes of method oriel.
#include "gather/photo.glsl"

// Unstructured lumigraph penalty (Buehler 2001, 4.2; resolution as in SIBR's ulr): the angle
// between the two lines of sight, and how much coarser the photograph sees the point. The
// constant keeps a photograph taken from here from silencing every other.
float photo_penalty(photo shot, vec3 p)
{
    vec3 to_photo = shot.eye.xyz - p;
    float here = length(p), there = length(to_photo);
    float angle = acos(clamp(dot(-p, to_photo) / (here * there), -1.0, 1.0));
    // Compare sizes of a pixel on the surface, not distances: focal lengths may differ.
    float coarser = there / here * (view_focal.x / shot.focal.x) - 1.0;
    return angle + 0.1 * max(coarser, 0.0) + 0.005;
}

// On known surfaces small penalties, up to about this many radians, differ little, and in proportion
// to their squares: a viewer who walks past a photograph's place would else see it, and it alone,
// flash up and go.
const float SURFACE_PENALTY = 0.3;

float photo_surface_penalty(float penalty)
{
    return length(vec2(penalty, SURFACE_PENALTY));
}

// Radians of parallax between the view and the photograph by which what is hidden lies behind a
// guess in a hole of the photograph's depth. In angles, since guesses of what is far are rough,
// and a photograph taken from beside the view shows the same hole in the same place.
const float GUESS_PARALLAX = 0.05;

// How much of the photograph around a pixel has nothing standing before z.
float photo_unhidden_share(photo shot, vec4 seen, float z)
{
    vec4 front = (z - seen) * (1.0 / (z * options.x)); // in tolerances
    vec4 nearer = -1.0 / min(seen, -1e-9) - 1.0 / z;
    vec4 behind_guess = nearer * (length(shot.eye.xyz) / GUESS_PARALLAX);
    front = mix(front, behind_guess, lessThan(seen, vec4(0.0)));
    vec4 share = mix(clamp(2.0 - front, 0.0, 1.0), vec4(1.0), equal(seen, vec4(0.0)));
    return dot(share, vec4(0.25)); // at an edge it shows some of what is behind
}

// A photograph with so great a penalty, an angle of some 50 degrees, shows another side of things:
// no help where depth is guessed.
const float GUESS_PENALTY_MOST = 0.9;

// From 1 to 0 there.
float photo_beside(float penalty)
{
    return clamp(3.0 * (1.0 - penalty / GUESS_PENALTY_MOST), 0.0, 1.0);
}

// Where photographs differ by this much, square roots of light, a guess is fully in doubt.
const float GUESS_DIFFERENCE = 0.1;
// Doubt in what one photograph shows alone: often enough it is right, and sharp.
const float GUESS_ALONE = 0.5;
// The same guess on the ground, which is known far better.
const float GROUND_DOUBT = 0.3;

// How far colour on guessed depth may lie from its place, log2 of pixels: in proportion to parallax
// (Eisemann 2007, Filtered Blending), the less the more the photographs agree. penalty: of the best
// one; share: its part in the colour.
float guess_blur(vec3 p, float penalty, float difference, float share)
{
    float alone = clamp(5.0 * share - 4.0, 0.0, 1.0);
    float doubt = clamp(max(difference / GUESS_DIFFERENCE, GUESS_ALONE * alone), 0.0, 1.0);
    float depths = p.z * dot(ground.xyz, vec3(p.xy / p.z, 1.0)); // of the ground's
    doubt *= abs(depths - 1.0) < 1e-3 ? GROUND_DOUBT : 1.0;
    return log2(max(choice_more.w * view_focal.x * penalty * doubt, 1.0));
}
