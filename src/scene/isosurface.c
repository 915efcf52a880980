#include "scene/isosurface.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "scene/mesh_internal.h"

struct nets {
    const struct orl_log *log;
    const struct orl_grid *grid;
    uint32_t *vertex_of; // vertex of each cell, by the cell's first sample; UINT32_MAX: none
    struct orl_mesh_builder builder;
};

static size_t sample_index(const struct orl_grid *grid, const int at[3])
{
    return (size_t)at[0] +
           (size_t)grid->size[0] * ((size_t)at[1] + (size_t)grid->size[1] * (size_t)at[2]);
}

// Mean of the crossings of the cell's 12 edges, of which there is one, in cells from its first corner.
static void cell_vertex(const float corner[8], double mean[3])
{
    int crossings = 0;
    double sum[3] = {0};
    for (int a = 0; a < 8; a++)
        for (int axis = 0; axis < 3; axis++) {
            int b = a | 1 << axis;
            if (b == a || (corner[a] < 0) == (corner[b] < 0))
                continue;
            double t = (double)corner[a] / ((double)corner[a] - (double)corner[b]);
            for (int k = 0; k < 3; k++)
                sum[k] += k == axis ? t : a >> k & 1;
            crossings++;
        }
    for (int k = 0; k < 3; k++)
        mean[k] = sum[k] / crossings;
}

// The samples at the corners of a cell. False if the surface does not pass between them, as in most
// cells.
static bool read_corners(const struct orl_grid *grid, const int at[3], float corner[8])
{
    size_t row = (size_t)grid->size[0], slice = row * (size_t)grid->size[1];
    const float *first = grid->value + sample_index(grid, at);
    int inside = 0;
    for (size_t c = 0; c < 8; c++) {
        corner[c] = first[(c & 1) + (c >> 1 & 1) * row + (c >> 2) * slice];
        inside += corner[c] < 0;
    }
    return inside > 0 && inside < 8;
}

static enum orl_result add_vertex(struct nets *n, const int at[3])
{
    const struct orl_grid *grid = n->grid;
    struct orl_mesh *mesh = &n->builder.mesh;
    float corner[8];
    double mean[3];
    if (!read_corners(grid, at, corner))
        return ORL_OK;
    cell_vertex(corner, mean);
    ORL_TRY(ORL_GROW(n->log, mesh->position, n->builder.vertex_capacity, mesh->vertex_count));
    for (int k = 0; k < 3; k++)
        mesh->position[mesh->vertex_count][k] =
            (float)(grid->origin[k] + (at[k] + mean[k]) * grid->spacing);
    n->vertex_of[sample_index(grid, at)] = (uint32_t)mesh->vertex_count++;
    return ORL_OK;
}

// Adds the quad around the edge from sample `at` along `axis`, if the surface crosses that edge.
static enum orl_result add_quad(struct nets *n, const int at[3], int axis)
{
    const struct orl_grid *grid = n->grid;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    int next[3] = {at[0], at[1], at[2]};
    next[axis]++;
    bool inside = grid->value[sample_index(grid, at)] < 0;
    if (next[axis] == grid->size[axis] ||
        inside == (grid->value[sample_index(grid, next)] < 0))
        return ORL_OK;
    // An edge on an outer face of the grid is not surrounded by four cells.
    if (at[u] < 1 || at[v] < 1 || at[u] + 1 >= grid->size[u] || at[v] + 1 >= grid->size[v])
        return orl_fail(n->log, ORL_ERR_DATA, "a surface reaches the end of its grid");
    uint32_t corners[4];
    for (int c = 0; c < 4; c++) {
        int cell[3] = {at[0], at[1], at[2]};
        cell[u] -= c == 1 || c == 2;
        cell[v] -= c >= 2;
        corners[c] = n->vertex_of[sample_index(grid, cell)];
    }
    if (!inside) { // the surface faces the other way
        uint32_t other = corners[1];
        corners[1] = corners[3];
        corners[3] = other;
    }
    return orl_mesh_add_polygon(n->log, &n->builder, corners, 4);
}

static enum orl_result add_all(struct nets *n)
{
    const int *size = n->grid->size;
    enum orl_result result = ORL_OK;
    int at[3];
    for (at[2] = 0; at[2] < size[2] - 1; at[2]++)
        for (at[1] = 0; at[1] < size[1] - 1; at[1]++)
            for (at[0] = 0; result == ORL_OK && at[0] < size[0] - 1; at[0]++)
                result = add_vertex(n, at);
    for (at[2] = 0; at[2] < size[2]; at[2]++)
        for (at[1] = 0; at[1] < size[1]; at[1]++)
            for (at[0] = 0; result == ORL_OK && at[0] < size[0]; at[0]++)
                for (int axis = 0; result == ORL_OK && axis < 3; axis++)
                    result = add_quad(n, at, axis);
    return result;
}

enum orl_result orl_isosurface(const struct orl_log *log, const struct orl_grid *grid,
                               struct orl_mesh *mesh)
{
    struct nets n = {.log = log, .grid = grid};
    memset(mesh, 0, sizeof *mesh);
    ORL_REQUIRE(log, grid->size[0] >= 2 && grid->size[1] >= 2 && grid->size[2] >= 2);
    size_t count = (size_t)grid->size[0] * (size_t)grid->size[1] * (size_t)grid->size[2];
    ORL_REQUIRE(log, count < UINT32_MAX);
    n.vertex_of = orl_array(log, count, sizeof *n.vertex_of);
    ORL_TRY_MEMORY(n.vertex_of);
    enum orl_result result = add_all(&n);
    free(n.vertex_of);
    if (result == ORL_OK)
        *mesh = n.builder.mesh;
    else
        orl_mesh_finish(&n.builder.mesh);
    return result;
}
