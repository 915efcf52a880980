// The penalty of a photograph for a surface point, shared by C and GLSL: unstructured lumigraph
// (Buehler 2001, 4.2), with the resolution term of SIBR's ulr.
#ifndef ORL_PENALTY_H
#define ORL_PENALTY_H

// Keeps the penalty above zero: a photograph taken from the viewpoint would otherwise outweigh all
// others completely.
#define ORL_PENALTY_MIN 0.005
#define ORL_PENALTY_OF_COARSENESS 0.1
// angle: between the two lines of sight, radians. coarser: the size of a pixel of the photograph on
// the surface divided by that of a pixel of the view, minus 1; negative values add no penalty.
#define ORL_PENALTY(angle, coarser) \
    ((angle) + ORL_PENALTY_OF_COARSENESS * ((coarser) > 0.0 ? (coarser) : 0.0) + ORL_PENALTY_MIN)

#endif
