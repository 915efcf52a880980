#include "scene/hull.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "scene/isosurface.h"

enum orl_result orl_silhouette_is_open(const struct orl_log *log, const struct orl_image *mask,
                                       bool *open)
{
    int largest, at_border;
    enum orl_result result = orl_bridge_pieces(log, mask, &largest, &at_border);
    *open = result == ORL_OK && at_border > 0 && 2 * at_border >= largest;
    return result;
}

// --- surface ---

enum orl_result orl_hull_field_mesh(const struct orl_log *log, const struct orl_hull *cube,
                                    const float *field, size_t triangles, struct orl_mesh *mesh)
{
    // Samples are the voxels' centres, with a border of samples outside the subject around.
    int n = cube->side + 2;
    size_t side = (size_t)cube->side, count = (size_t)n * (size_t)n * (size_t)n;
    memset(mesh, 0, sizeof *mesh);
    float *value = orl_array(log, count, sizeof *value);
    ORL_TRY_MEMORY(value);
    for (size_t i = 0; i < count; i++)
        value[i] = (float)cube->voxel;
    for (size_t z = 0; z < side; z++)
        for (size_t y = 0; y < side; y++)
            memcpy(value + 1 + (size_t)n * (y + 1 + (size_t)n * (z + 1)),
                   field + side * (y + side * z), side * sizeof *value);
    struct orl_grid grid = {.size = {n, n, n}, .spacing = cube->voxel, .value = value};
    for (int k = 0; k < 3; k++)
        grid.origin[k] = cube->origin[k] - 0.5 * cube->voxel;
    enum orl_result result = orl_isosurface(log, &grid, mesh);
    free(value);
    if (result == ORL_OK && !mesh->triangle_count)
        result = orl_fail(log, ORL_ERR_DATA, "the hull is empty");
    if (result == ORL_OK && triangles)
        result = orl_mesh_decimate(log, triangles, mesh);
    ORL_THEN(result, orl_mesh_set_normals(log, mesh));
    if (result != ORL_OK)
        orl_mesh_finish(mesh);
    return result;
}
