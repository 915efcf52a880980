// Shared by the readers of meshes.
#ifndef ORL_SCENE_MESH_INTERNAL_H
#define ORL_SCENE_MESH_INTERNAL_H

#include "scene/mesh.h"

// A mesh of unknown size being read.
struct orl_mesh_builder {
    struct orl_mesh mesh;
    double origin[3]; // taken off the positions of the file
    size_t vertex_capacity, color_capacity, triangle_capacity;
};

// Adds a polygon as a fan of triangles around its first corner.
enum orl_result orl_mesh_add_polygon(const struct orl_log *log, struct orl_mesh_builder *builder,
                                     const uint32_t *corners, size_t count) ORL_CHECK_RESULT;
enum orl_result orl_mesh_read_ply(const struct orl_log *log, const char *path,
                                  struct orl_mesh_builder *builder) ORL_CHECK_RESULT;
enum orl_result orl_mesh_read_obj(const struct orl_log *log, const char *path,
                                  struct orl_mesh_builder *builder) ORL_CHECK_RESULT;

#endif
