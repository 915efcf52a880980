// Surfaces of fields on grids, as meshes.
#ifndef ORL_SCENE_ISOSURFACE_H
#define ORL_SCENE_ISOSURFACE_H

#include "scene/mesh.h"

// Samples of a field: negative inside, x fastest. Samples on the outer faces of the grid must be
// >= 0, so that the surface is closed.
struct orl_grid {
    int size[3];       // samples along each axis, >= 2
    double origin[3];  // world position of sample 0 0 0
    double spacing;    // between samples, scene units
    const float *value;
};

// Extracts the surface where the field is 0, by surface nets (Gibson 1998). Each cell that the
// surface passes through gets one vertex, at the mean of the crossings of the cell's edges. Each
// edge that the surface crosses gets a quad of two triangles. The method is the dual of marching
// cubes: equally close to the field, with better triangles and without case tables.
enum orl_result orl_isosurface(const struct orl_log *log, const struct orl_grid *grid,
                               struct orl_mesh *mesh) ORL_CHECK_RESULT;

#endif
