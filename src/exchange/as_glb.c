// Binary glTF 2.0: one primitive of points with KHR_gaussian_splatting. A program that does not
// know the extension draws its points in COLOR_0.
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/color.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "exchange/gaussians.h"
#include "exchange/kinds.h"
#include "scene/info.h"
#include "scene/ply.h"
#include "scene/upright.h"

enum { GL_UNSIGNED_SHORT_ = 5123, GL_FLOAT_ = 5126, GL_ARRAY_BUFFER_ = 34962, POINTS_ = 0 };

// A vertex in the buffer, as far as its terms go. glTF stores linear colours and xyzw.
struct vertex {
    float position[3], rotation_xyzw[4], scale[3], opacity;
    uint16_t color[4];
    float harmonics[ORL_HARMONICS_MAX][3];
};
_Static_assert(sizeof(struct vertex) == 52 + 108, "attributes are packed");

static size_t stride(const struct orl_gaussians *g)
{
    return offsetof(struct vertex, harmonics) + (size_t)g->terms * 12;
}

static void pack(const struct orl_gaussians *g, size_t i, struct vertex *v)
{
    struct orl_gaussian shape;
    orl_gaussian_shape(g, i, &shape);
    memcpy(v->position, g->points->position[i], sizeof v->position);
    memcpy(v->rotation_xyzw, shape.rotation_wxyz + 1, 12);
    v->rotation_xyzw[3] = shape.rotation_wxyz[0];
    memcpy(v->scale, shape.scale, sizeof v->scale);
    v->opacity = shape.opacity;
    memcpy(v->harmonics, g->harmonics + i * (size_t)g->terms * 3, (size_t)g->terms * 12);
    for (int c = 0; c < 3; c++) {
        float srgb = v->harmonics[0][c] * (float)ORL_HARMONIC_0 + 0.5f;
        float linear = orl_srgb_decode(srgb < 0 ? 0 : srgb < 1 ? srgb : 1);
        v->color[c] = (uint16_t)lrintf(65535 * linear);
    }
    v->color[3] = (uint16_t)lrintf(65535 * shape.opacity);
}

// --- JSON ---

// Adds the accessor of an attribute, which lies at `offset` of each vertex.
static void add_attribute(json_t *root, json_t *attributes, const char *name, size_t offset,
                          int type, const char *shape, size_t count)
{
    json_t *accessors = json_object_get(root, "accessors");
    json_object_set_new(attributes, name, json_integer((json_int_t)json_array_size(accessors)));
    json_t *accessor = json_pack("{s:i, s:I, s:i, s:I, s:s}", "bufferView", 0, "byteOffset",
                                 (json_int_t)offset, "componentType", type, "count",
                                 (json_int_t)count, "type", shape);
    if (type == GL_UNSIGNED_SHORT_)
        json_object_set_new(accessor, "normalized", json_true());
    json_array_append_new(accessors, accessor);
}

static void add_bounds(json_t *root, const struct orl_points *points)
{
    double low[3], high[3];
    orl_points_bounds(points, low, high);
    json_t *position = json_array_get(json_object_get(root, "accessors"), 0);
    json_object_set_new(position, "min", json_pack("[f, f, f]", low[0], low[1], low[2]));
    json_object_set_new(position, "max", json_pack("[f, f, f]", high[0], high[1], high[2]));
}

// The rotation, x y z w, by which the photographs' upward direction becomes glTF's, +y.
static json_t *upright(const struct orl_scene *scene)
{
    double up[3], axis[3], half;
    orl_scene_mean_up(scene, up);
    orl_cross3(up, (double[3]){0, 1, 0}, axis);
    half = 1 + up[1];
    if (half < 1e-9) // upside down: half a turn about x
        return json_pack("[i, i, i, i]", 1, 0, 0, 0);
    double length = sqrt(orl_dot3(axis, axis) + half * half);
    return json_pack("[f, f, f, f]", axis[0] / length, axis[1] / length, axis[2] / length,
                     half / length);
}

static json_t *describe(const struct orl_scene *scene, const struct orl_gaussians *g)
{
    size_t count = g->points->count, bytes = count * stride(g);
    json_t *attributes = json_object();
    json_t *root = json_pack(
        "{s:{s:s, s:s}, s:[s], s:i, s:[{s:[i]}], s:[{s:i, s:o}], s:[], s:[{s:i, s:I, s:I, s:i}],"
        " s:[{s:I}]}",
        "asset", "version", "2.0", "generator", "oriel " ORL_VERSION,
        "extensionsUsed", "KHR_gaussian_splatting", "scene", 0, "scenes", "nodes", 0,
        "nodes", "mesh", 0, "rotation", upright(scene), "accessors",
        "bufferViews", "buffer", 0, "byteLength", (json_int_t)bytes, "byteStride",
        (json_int_t)stride(g), "target", GL_ARRAY_BUFFER_,
        "buffers", "byteLength", (json_int_t)bytes);
    add_attribute(root, attributes, "POSITION", offsetof(struct vertex, position), GL_FLOAT_,
                  "VEC3", count);
    add_bounds(root, g->points);
    add_attribute(root, attributes, "COLOR_0", offsetof(struct vertex, color), GL_UNSIGNED_SHORT_,
                  "VEC4", count);
    add_attribute(root, attributes, "KHR_gaussian_splatting:ROTATION",
                  offsetof(struct vertex, rotation_xyzw), GL_FLOAT_, "VEC4", count);
    add_attribute(root, attributes, "KHR_gaussian_splatting:SCALE", offsetof(struct vertex, scale),
                  GL_FLOAT_, "VEC3", count);
    add_attribute(root, attributes, "KHR_gaussian_splatting:OPACITY",
                  offsetof(struct vertex, opacity), GL_FLOAT_, "SCALAR", count);
    for (int degree = 0, term = 0; degree <= g->degree; degree++)
        for (int k = 0; k <= 2 * degree; k++, term++) {
            char name[64];
            snprintf(name, sizeof name, "KHR_gaussian_splatting:SH_DEGREE_%d_COEF_%d", degree, k);
            add_attribute(root, attributes, name,
                          offsetof(struct vertex, harmonics) + 12 * (size_t)term, GL_FLOAT_,
                          "VEC3", count);
        }
    json_object_set_new(root, "meshes", json_pack(
        "[{s:[{s:i, s:o, s:{s:{s:s, s:s, s:s, s:s}}}]}]", "primitives", "mode", POINTS_,
        "attributes", attributes, "extensions", "KHR_gaussian_splatting", "kernel", "ellipse",
        "colorSpace", "srgb_rec709_display", "projection", "perspective", "sortingMethod",
        "cameraDistance"));
    return root;
}

// --- the file ---

static void write_all(FILE *stream, const struct orl_gaussians *g, const char *json)
{
    size_t length = strlen(json), padded = (length + 3) / 4 * 4, bytes = g->points->count * stride(g);
    // Of the file: its version and length; of each chunk: its length.
    const uint32_t head[] = {2, (uint32_t)(12 + 8 + padded + 8 + bytes), (uint32_t)padded}, rest = (uint32_t)bytes;
    fputs("glTF", stream);
    fwrite(head, sizeof head, 1, stream);
    fprintf(stream, "JSON%s%*s", json, (int)(padded - length), "");
    fwrite(&rest, sizeof rest, 1, stream);
    fwrite("BIN", 4, 1, stream); // with its 0
    for (size_t i = 0; i < g->points->count; i++) {
        struct vertex vertex;
        pack(g, i, &vertex);
        fwrite(&vertex, stride(g), 1, stream);
    }
}

static enum orl_result write_file(const struct orl_log *log, const char *path,
                                  const struct orl_gaussians *g, const char *json)
{
    struct orl_atomic_file file;
    ORL_TRY(orl_atomic_open(log, path, &file));
    write_all(file.stream, g, json);
    return orl_atomic_commit(log, &file);
}

ORL_EXPORT_WRITER(orl_export_glb)
{
    static const size_t most = UINT32_MAX - (1 << 20); // less the header
    struct orl_gaussians g = {0};
    char *json = NULL;
    if (!scene->points.count)
        return orl_fail(log, ORL_ERR_DATA, "%s has no points, and glTF knows no empty mesh",
                        scene->dir);
    enum orl_result result =
        orl_gaussians_fit(log, progress, scene, params->degree < 0 ? 1 : params->degree, &g);
    if (result == ORL_OK && scene->points.count > most / stride(&g))
        result = orl_fail(log, ORL_ERR_UNSUPPORTED, "%zu points do not fit into the 4 GiB of a "
                          "GLB file: export as splats, or trim the scene", scene->points.count);
    if (result == ORL_OK) {
        json_t *root = describe(scene, &g);
        json = json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(17));
        json_decref(root);
        result = json ? write_file(log, params->out, &g, json)
                      : orl_fail(log, ORL_ERR_MEMORY, "%s: out of memory", params->out);
    }
    free(json);
    orl_gaussians_finish(&g);
    return result;
}
