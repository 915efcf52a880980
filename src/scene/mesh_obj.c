// Meshes from Wavefront OBJ: v and f are read, other statements are skipped.
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "scene/mesh_internal.h"
#include "scene/text_lines.h"

struct obj {
    struct orl_text_lines l;
    struct orl_mesh_builder *builder;
    bool colors; // every vertex so far has a colour
};

static enum orl_result read_vertex(struct obj *obj)
{
    struct orl_mesh *mesh = &obj->builder->mesh;
    double p[3], c[3];
    if (!orl_text_numbers(&obj->l, p, 3))
        return orl_text_bad(&obj->l, "a vertex needs 3 numbers");
    if (mesh->vertex_count == UINT32_MAX)
        return orl_text_bad(&obj->l, "more than 2^32 vertices");
    ORL_TRY(ORL_GROW(obj->l.log, mesh->position, obj->builder->vertex_capacity, mesh->vertex_count));
    ORL_TRY(ORL_GROW(obj->l.log, mesh->color, obj->builder->color_capacity, mesh->vertex_count));
    obj->colors = obj->colors && orl_text_numbers(&obj->l, c, 3);
    for (int k = 0; k < 3; k++) {
        double v = obj->colors ? 255 * c[k] : 0;
        mesh->position[mesh->vertex_count][k] = (float)(p[k] - obj->builder->origin[k]);
        mesh->color[mesh->vertex_count][k] = (uint8_t)(v >= 255 ? 255 : v > 0 ? v + 0.5 : 0);
    }
    mesh->vertex_count++;
    return ORL_OK;
}

// Reads a corner: "7", "7/1", "7//3", "7/1/3", or "-1", which counts back from the last vertex.
static bool read_corner(struct obj *obj, uint32_t *corner)
{
    char *end;
    long long index = strtoll(obj->l.at, &end, 10);
    size_t count = obj->builder->mesh.vertex_count;
    if (end == obj->l.at || strcspn(end, " \t") != strspn(end, "/-0123456789"))
        return false;
    obj->l.at = end + strcspn(end, " \t");
    if (index < 0)
        index += (long long)count + 1;
    if (index < 1 || (unsigned long long)index > count)
        return false;
    *corner = (uint32_t)(index - 1);
    return true;
}

static enum orl_result read_face(struct obj *obj, uint32_t **corners, size_t *capacity)
{
    size_t count = 0;
    for (;;) {
        obj->l.at += strspn(obj->l.at, " \t");
        if (!*obj->l.at)
            break;
        ORL_TRY(ORL_GROW(obj->l.log, *corners, *capacity, count));
        if (!read_corner(obj, &(*corners)[count++]))
            return orl_text_bad(&obj->l, "a face refers to a vertex that is not there");
    }
    if (count < 3)
        return orl_text_bad(&obj->l, "a face needs three corners");
    return orl_mesh_add_polygon(obj->l.log, obj->builder, *corners, count);
}

enum orl_result orl_mesh_read_obj(const struct orl_log *log, const char *path,
                                  struct orl_mesh_builder *builder)
{
    struct obj obj = {.builder = builder, .colors = true};
    uint32_t *corners = NULL;
    size_t capacity = 0;
    ORL_TRY(orl_text_open(log, path, &obj.l));
    enum orl_result result = ORL_OK;
    while (result == ORL_OK && orl_text_next(&obj.l)) {
        bool vertex = strncmp(obj.l.at, "v ", 2) == 0, face = strncmp(obj.l.at, "f ", 2) == 0;
        if (vertex || face)
            obj.l.at += 2;
        result = vertex ? read_vertex(&obj)
                 : face ? read_face(&obj, &corners, &capacity)
                        : ORL_OK;
    }
    if (!obj.colors) {
        free(builder->mesh.color);
        builder->mesh.color = NULL;
    }
    free(corners);
    orl_text_close(&obj.l);
    return result;
}
