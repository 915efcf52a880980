// The penalty of a photograph for a surface point, shared by C and GLSL: unstructured lumigraph
// (Buehler 2001, 4.2; resolution as in SIBR's ulr).
#ifndef ORL_PENALTY_H
#define ORL_PENALTY_H

// A photograph taken from here must not silence every other.
#define ORL_PENALTY_LEAST 0.005
#define ORL_PENALTY_OF_COARSENESS 0.1
// angle: between the two lines of sight, radians. coarser: how many times as large a pixel of the
// photograph is on the surface as one of the view, less 1; only what is above 0 counts.
#define ORL_PENALTY(angle, coarser) \
    ((angle) + ORL_PENALTY_OF_COARSENESS * ((coarser) > 0.0 ? (coarser) : 0.0) + ORL_PENALTY_LEAST)

#endif
