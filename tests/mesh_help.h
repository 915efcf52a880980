#ifndef ORL_TESTS_MESH_HELP_H
#define ORL_TESTS_MESH_HELP_H

#include <stdlib.h>

#include "scene/mesh.h"

// Zeroed vertices and triangles, without normals and colours.
static inline struct orl_mesh mesh_of(size_t vertex_count, size_t triangle_count)
{
    struct orl_mesh mesh = {.vertex_count = vertex_count, .triangle_count = triangle_count};
    mesh.position = calloc(vertex_count, sizeof *mesh.position);
    mesh.triangle = calloc(triangle_count, sizeof *mesh.triangle);
    if (!mesh.position || !mesh.triangle)
        abort();
    return mesh;
}

// Volume enclosed by a closed mesh, positive when its triangles face outward.
static inline double mesh_volume(const struct orl_mesh *mesh)
{
    double sum = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const float *a = mesh->position[mesh->triangle[i][0]];
        const float *b = mesh->position[mesh->triangle[i][1]];
        const float *c = mesh->position[mesh->triangle[i][2]];
        for (int k = 0; k < 3; k++) {
            int x = (k + 1) % 3, y = (k + 2) % 3;
            sum += (double)a[k] * ((double)b[x] * (double)c[y] - (double)b[y] * (double)c[x]);
        }
    }
    return sum / 6;
}

#endif
