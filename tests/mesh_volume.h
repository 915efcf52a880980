#ifndef ORL_TESTS_MESH_VOLUME_H
#define ORL_TESTS_MESH_VOLUME_H

#include "scene/mesh.h"

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
