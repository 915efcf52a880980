// Surfaces of fields on grids, as meshes.
#ifndef ORL_SCENE_ISOSURFACE_H
#define ORL_SCENE_ISOSURFACE_H

#include "scene/mesh.h"

// Samples of a field: negative inside, x fastest. Those on the outer faces of the grid must not be
// negative, so that the surface is closed.
struct orl_grid {
    int size[3];       // samples along each axis, >= 2
    double origin[3];  // world position of sample 0 0 0
    double spacing;    // between samples, scene units
    const float *value;
};

// The surface where the field is 0, by surface nets (Gibson 1998): one vertex in each cell that it
// passes through, the mean of where it crosses the cell's edges, and one quad, cut in two, for
// each edge that is crossed. Marching cubes' dual: as close to the field, with better triangles
// and without its tables.
enum orl_result orl_isosurface(const struct orl_log *log, const struct orl_grid *grid,
                               struct orl_mesh *mesh) ORL_CHECK_RESULT;

#endif
