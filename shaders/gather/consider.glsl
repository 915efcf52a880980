// How well a photograph can paint a surface point, for the painter `tiled` and for the page. The file that
// includes this one defines
//   float surface_share(photo source, surface_point s, vec4 seen, float z): what the photograph sees of a point on
//       a known surface;
//   float surface_penalty(float penalty): the penalty of such a point.
// RESTS: the backdrop rests in the photographs.
#include "gather/backdrop.glsl"

// source: photograph i; i < 0: there is none. A photograph that cannot paint the point has the penalty
// NOT_SEEN.
observation consider(int i, photo source, surface_point s)
{
    vec2 pixel;
    float z;
    bool inside = photo_project(source, s.p, pixel, z);
    vec4 seen = photo_depths(source, pixel);
    float penalty = photo_penalty(source, s.p);
    // Estimated depth is tested even if the method has no visibility test: it is behind everything.
    float sees = is_guess(s) ? photo_unhidden_share(source, seen, z) * photo_beside(penalty)
                             : surface_share(source, s, seen, z);
    penalty = is_guess(s) ? penalty : surface_penalty(penalty);
#ifdef RESTS
    vec2 place;
    bool backdrop = photo_backdrop(source, s.p, place) && is_guess(s);
    inside = inside || backdrop;
    pixel = backdrop ? place : pixel;
    z = backdrop ? s.p.z : z;
    sees = backdrop ? 1.0 : sees;
#endif
    float sure = sees * photo_border(source, pixel) * (is_guess(s) ? photo_feather(source, pixel) : 1.0);
    bool paints = i >= 0 && s.p.z > 0.0 && inside && sees > 1e-4;
    // What does not paint is read all the same, with the weight 0.
    return observation(paints ? penalty / sure : NOT_SEEN, max(i, 0), paints ? pixel : vec2(0.0),
                 paints ? photo_mip(source, z, s.p.z) : 0.0);
}
