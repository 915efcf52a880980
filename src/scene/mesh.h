// Triangle meshes.
#ifndef ORL_SCENE_MESH_H
#define ORL_SCENE_MESH_H

#include "oriel/log.h"

struct orl_mesh {
    size_t vertex_count, triangle_count;
    float (*position)[3];    // world, scene units
    float (*normal)[3];      // unit length, 0 0 0: unknown; NULL: none
    uint8_t (*color)[3];     // sRGB; NULL: none
    uint32_t (*triangle)[3]; // vertex indices, counter-clockwise as seen from outside
};

void orl_mesh_finish(struct orl_mesh *mesh);

// Reads PLY (ascii or binary little endian: x y z, optional nx ny nz and red green blue; faces as
// vertex_indices or vertex_index) and Wavefront OBJ (v with optional colour, f), recognised by
// content. Polygons become fans of triangles. ORL_ERR_FORMAT: an index of a missing vertex, a
// vertex that is not finite, or no face. `origin` is taken off the positions before they become
// floats; NULL: nothing is.
enum orl_result orl_mesh_read(const struct orl_log *log, const char *path, const double *origin,
                              struct orl_mesh *mesh) ORL_CHECK_RESULT;
// Writes binary little-endian PLY, atomically.
enum orl_result orl_mesh_write(const struct orl_log *log, const char *path,
                               const struct orl_mesh *mesh) ORL_CHECK_RESULT;

// Sets vertex normals: the mean of the adjacent triangles' normals, weighted by area.
enum orl_result orl_mesh_set_normals(const struct orl_log *log,
                                     struct orl_mesh *mesh) ORL_CHECK_RESULT;
// Reduces the mesh to `target` triangles where the shape allows (meshoptimizer: quadric error edge
// collapse). Unused vertices are dropped.
enum orl_result orl_mesh_decimate(const struct orl_log *log, size_t target,
                                  struct orl_mesh *mesh) ORL_CHECK_RESULT;

#endif
