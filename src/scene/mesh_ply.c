// Meshes from PLY.
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "scene/mesh_internal.h"
#include "scene/ply.h"

// Indices of three properties; false when one is missing.
static bool find_three(const struct orl_ply_element *element, const char *const names[3],
                       int found[3])
{
    for (int k = 0; k < 3; k++)
        if ((found[k] = orl_ply_property_index(element, names[k])) < 0)
            return false;
    return true;
}

// The factor that brings a colour of this type to 255 at white, which is 1 of floats.
static double color_scale(enum orl_ply_type type)
{
    return type >= ORL_PLY_FLOAT32 ? 255 : type == ORL_PLY_UINT16 ? 255.0 / 65535 : 1;
}

static enum orl_result read_vertices(struct orl_ply *ply, const struct orl_ply_element *element,
                                     struct orl_mesh_builder *builder)
{
    struct orl_mesh *mesh = &builder->mesh;
    static const char *const position[] = {"x", "y", "z"}, *const normal[] = {"nx", "ny", "nz"},
                             *const color[] = {"red", "green", "blue"};
    double record[ORL_PLY_PROPERTIES_MAX];
    int at[3], n_at[3], c_at[3];
    if (!find_three(element, position, at))
        return orl_ply_bad(ply, "the vertices lack x, y or z");
    if (element->count > UINT32_MAX)
        return orl_ply_bad(ply, "more than 2^32 vertices");
    bool normals = find_three(element, normal, n_at), colors = find_three(element, color, c_at);
    size_t count = (size_t)element->count;
    mesh->position = orl_array(ply->log, count, sizeof *mesh->position);
    mesh->normal = normals ? orl_array(ply->log, count, sizeof *mesh->normal) : NULL;
    mesh->color = colors ? orl_array(ply->log, count, sizeof *mesh->color) : NULL;
    ORL_TRY_MEMORY(mesh->position && (mesh->normal || !normals) && (mesh->color || !colors));
    mesh->vertex_count = count;
    for (size_t i = 0; i < count; i++) {
        ORL_TRY(orl_ply_record(ply, element, record, -1, NULL));
        for (int k = 0; k < 3; k++) {
            mesh->position[i][k] = (float)(record[at[k]] - builder->origin[k]);
            if (normals)
                mesh->normal[i][k] = (float)record[n_at[k]];
            double c = colors ? record[c_at[k]] * color_scale(element->properties[c_at[k]].type) : 0;
            if (colors)
                mesh->color[i][k] = (uint8_t)(c >= 255 ? 255 : c > 0 ? c + 0.5 : 0);
        }
    }
    return ORL_OK;
}

static enum orl_result read_faces(struct orl_ply *ply, const struct orl_ply_element *element,
                                  struct orl_mesh_builder *builder)
{
    double record[ORL_PLY_PROPERTIES_MAX];
    struct orl_ply_list list = {0};
    uint32_t *corners = NULL;
    size_t capacity = 0;
    int at = orl_ply_property_index(element, "vertex_indices");
    if (at < 0)
        at = orl_ply_property_index(element, "vertex_index");
    if (at < 0 || !element->properties[at].list)
        return orl_ply_bad(ply, "the faces lack a list of vertex_indices");
    enum orl_result result = ORL_OK;
    for (uint64_t i = 0; result == ORL_OK && i < element->count; i++) {
        result = orl_ply_record(ply, element, record, at, &list);
        ORL_THEN(result, orl_grow(ply->log, (void **)&corners, &capacity, list.count, sizeof *corners));
        for (size_t k = 0; result == ORL_OK && k < list.count; k++) {
            double index = list.items[k];
            if (!(index >= 0 && index < (double)builder->mesh.vertex_count))
                result = orl_ply_bad(ply, "a face refers to a vertex that is not there");
            else
                corners[k] = (uint32_t)index;
        }
        ORL_THEN(result, orl_mesh_add_polygon(ply->log, builder, corners, list.count));
    }
    free(corners);
    free(list.items);
    return result;
}

enum orl_result orl_mesh_read_ply(const struct orl_log *log, const char *path,
                                  struct orl_mesh_builder *builder)
{
    struct orl_ply ply;
    const struct orl_ply_element *vertex = NULL, *face = NULL;
    ORL_TRY(orl_ply_open(log, path, &ply));
    enum orl_result result = orl_ply_seek(&ply, "vertex", "no vertices", &vertex);
    ORL_THEN(result, read_vertices(&ply, vertex, builder));
    ORL_THEN(result, orl_ply_seek(&ply, "face", "no faces after the vertices", &face));
    ORL_THEN(result, read_faces(&ply, face, builder));
    orl_ply_close(&ply);
    return result;
}
