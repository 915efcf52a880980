// Private to src/render: triangle meshes as the proxy.
#ifndef ORL_RENDER_MESH_PROXY_H
#define ORL_RENDER_MESH_PROXY_H

#include "render/proxy/proxy.h"
#include "scene/mesh.h"

// Target of a proxy that the graphics pipeline draws.
struct raster_target {
    struct surface surface;
    struct orl_tex *test; // the depth test's own
};

// State of a proxy that is a mesh, or its first member.
struct mesh_state {
    struct orl_mesh mesh; // owned
    struct orl_buf *vertices, *indices;
    struct orl_buf *colors; // sRGB and a spare byte of each vertex; NULL: it has none
    float low[3], high[3]; // bounding box, world
    int time_step;            // of the scene, whose mesh was read
};

// Brings state->mesh, which has triangles, to the device and finds its bounding box.
enum orl_result orl_mesh_state_upload(struct orl_gpu *gpu, struct mesh_state *state);
void orl_mesh_state_finish(struct orl_gpu *gpu, void *state);
// The range of depths before the camera that the bounding box takes, with a small margin (Li 2003,
// 5.2.3: a tight range makes depth precise).
void orl_mesh_range(const struct mesh_state *state, const struct orl_view *view, float *near,
                    float *far);
// As struct orl_proxy_kind asks for them.
enum orl_result orl_raster_target_make(struct orl_gpu *gpu, const void *state, void *target);
void orl_mesh_vertices(const void *state, const struct orl_scene *scene,
                       const float (**vertices)[3], size_t *count);
void orl_mesh_draw(struct orl_gpu *gpu, const void *state, const struct orl_view *view,
                   const struct orl_render_params *params, bool normals, void *target);

#endif
