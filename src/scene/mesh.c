#include "scene/mesh.h"

#include <math.h>
#include <meshoptimizer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "scene/mesh_internal.h"

void orl_mesh_finish(struct orl_mesh *mesh)
{
    if (!mesh)
        return;
    free(mesh->position);
    free(mesh->normal);
    free(mesh->color);
    free(mesh->triangle);
    memset(mesh, 0, sizeof *mesh);
}

// --- reading ---

enum orl_result orl_mesh_add_polygon(const struct orl_log *log, struct orl_mesh_builder *builder,
                                     const uint32_t *corners, size_t count)
{
    struct orl_mesh *mesh = &builder->mesh;
    if (count < 3)
        return ORL_OK;
    ORL_TRY(orl_grow(log, (void **)&mesh->triangle, &builder->triangle_capacity,
                     mesh->triangle_count + count - 2, sizeof *mesh->triangle));
    for (size_t i = 2; i < count; i++) {
        uint32_t *triangle = mesh->triangle[mesh->triangle_count++];
        triangle[0] = corners[0];
        triangle[1] = corners[i - 1];
        triangle[2] = corners[i];
    }
    return ORL_OK;
}

static enum orl_result check(const struct orl_log *log, const char *path,
                             const struct orl_mesh *mesh)
{
    if (!mesh->triangle_count)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: no faces", path);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            if (!isfinite(mesh->position[i][k]))
                return orl_fail(log, ORL_ERR_FORMAT, "%s: vertex %zu is not finite", path, i);
    return ORL_OK;
}

enum orl_result orl_mesh_read(const struct orl_log *log, const char *path, const double *origin,
                              struct orl_mesh *mesh)
{
    struct orl_mesh_builder builder = {0};
    char magic[4] = "";
    memset(mesh, 0, sizeof *mesh);
    if (origin)
        memcpy(builder.origin, origin, sizeof builder.origin);
    FILE *stream;
    ORL_TRY(orl_file_open(log, path, &stream));
    size_t got = fread(magic, 1, 3, stream);
    fclose(stream);
    enum orl_result result = got == 3 && strcmp(magic, "ply") == 0 ? orl_mesh_read_ply(log, path, &builder)
                                                                   : orl_mesh_read_obj(log, path, &builder);
    ORL_THEN(result, check(log, path, &builder.mesh));
    if (result == ORL_OK)
        *mesh = builder.mesh;
    else
        orl_mesh_finish(&builder.mesh);
    return result;
}

// --- writing ---

enum orl_result orl_mesh_write(const struct orl_log *log, const char *path,
                               const struct orl_mesh *mesh)
{
    struct orl_atomic_file file;
    ORL_TRY(orl_atomic_open(log, path, &file));
    fprintf(file.stream,
            "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty float x\n"
            "property float y\nproperty float z\n%s%selement face %zu\n"
            "property list uchar int vertex_indices\nend_header\n", mesh->vertex_count,
            mesh->normal ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
            mesh->color ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "",
            mesh->triangle_count);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        fwrite(mesh->position[i], sizeof *mesh->position, 1, file.stream);
        if (mesh->normal)
            fwrite(mesh->normal[i], sizeof *mesh->normal, 1, file.stream);
        if (mesh->color)
            fwrite(mesh->color[i], sizeof *mesh->color, 1, file.stream);
    }
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        fputc(3, file.stream);
        fwrite(mesh->triangle[i], sizeof *mesh->triangle, 1, file.stream);
    }
    return orl_atomic_commit(log, &file);
}

// --- geometry ---

// Normal of a triangle, with a length of twice its area.
static void face_normal(const struct orl_mesh *mesh, size_t i, double normal[3])
{
    const uint32_t *t = mesh->triangle[i];
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)mesh->position[t[1]][k] - (double)mesh->position[t[0]][k];
        b[k] = (double)mesh->position[t[2]][k] - (double)mesh->position[t[0]][k];
    }
    orl_cross3(a, b, normal);
}

enum orl_result orl_mesh_set_normals(const struct orl_log *log, struct orl_mesh *mesh)
{
    double (*sum)[3] = orl_array(log, mesh->vertex_count, sizeof *sum);
    float (*normal)[3] = orl_array(log, mesh->vertex_count, sizeof *normal);
    if (!sum || !normal) {
        free(sum);
        free(normal);
        return ORL_ERR_MEMORY;
    }
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        double face[3];
        face_normal(mesh, i, face);
        for (int corner = 0; corner < 3; corner++)
            for (int k = 0; k < 3; k++)
                sum[mesh->triangle[i][corner]][k] += face[k];
    }
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        orl_normalize3(sum[i]);
        for (int k = 0; k < 3; k++)
            normal[i][k] = (float)sum[i][k];
    }
    free(sum);
    free(mesh->normal);
    mesh->normal = normal;
    return ORL_OK;
}

// Drops the vertices that no triangle uses. The others come in the order in which triangles use them.
static enum orl_result drop_unused(const struct orl_log *log, struct orl_mesh *mesh)
{
    size_t all = mesh->vertex_count, corners = 3 * mesh->triangle_count;
    uint32_t *to = orl_array(log, all, sizeof *to), *first = mesh->triangle[0];
    ORL_TRY_MEMORY(to);
    mesh->vertex_count = meshopt_optimizeVertexFetchRemap(to, first, corners, all);
    meshopt_remapVertexBuffer(mesh->position, mesh->position, all, sizeof *mesh->position, to);
    if (mesh->normal)
        meshopt_remapVertexBuffer(mesh->normal, mesh->normal, all, sizeof *mesh->normal, to);
    if (mesh->color)
        meshopt_remapVertexBuffer(mesh->color, mesh->color, all, sizeof *mesh->color, to);
    meshopt_remapIndexBuffer(first, first, corners, to);
    free(to);
    return ORL_OK;
}

enum orl_result orl_mesh_decimate(const struct orl_log *log, size_t target, struct orl_mesh *mesh)
{
    if (mesh->triangle_count <= target)
        return ORL_OK;
    uint32_t (*triangle)[3] = orl_array(log, mesh->triangle_count, sizeof *triangle);
    ORL_TRY_MEMORY(triangle);
    // The error is unlimited, since the number of triangles is the target.
    size_t count = meshopt_simplify(&triangle[0][0], &mesh->triangle[0][0],
                                    3 * mesh->triangle_count, &mesh->position[0][0],
                                    mesh->vertex_count, sizeof *mesh->position, 3 * target,
                                    1.0f, 0, NULL);
    free(mesh->triangle);
    mesh->triangle = triangle;
    mesh->triangle_count = count / 3;
    return drop_unused(log, mesh);
}
