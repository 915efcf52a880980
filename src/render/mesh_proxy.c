// A triangle mesh as the proxy: SCENE/mesh.ply, drawn by the graphics pipeline.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "gpu/raster.h"
#include "render/frame.h"
#include "render/proxy.h"
#include "scene/mesh.h"
#include "shared/render_blocks.h"

struct mesh_state {
    struct orl_mesh mesh; // owned
    struct orl_buf *vertices, *indices;
    float low[3], high[3]; // bounding box, world
};

struct mesh_target {
    int width, height;
    struct orl_tex *depth, *normal; // of struct surface
    struct orl_tex *test;           // the depth test's own
};

static void destroy(struct orl_gpu *gpu, void **handle)
{
    struct mesh_state *state = *handle;
    if (!state)
        return;
    orl_buf_destroy(gpu, &state->vertices);
    orl_buf_destroy(gpu, &state->indices);
    orl_mesh_finish(&state->mesh);
    free(state);
    *handle = NULL;
}

static void vertices(const void *handle, const struct orl_scene *scene, const float (**out)[3],
                     size_t *count)
{
    const struct mesh_state *state = handle;
    (void)scene;
    *out = (const float(*)[3])state->mesh.position;
    *count = state->mesh.vertex_count;
}

static enum orl_result upload(struct orl_gpu *gpu, struct mesh_state *state)
{
    const struct orl_mesh *mesh = &state->mesh;
    memcpy(state->low, mesh->position[0], sizeof state->low);
    memcpy(state->high, mesh->position[0], sizeof state->high);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            state->low[k] = fminf(state->low[k], mesh->position[i][k]);
            state->high[k] = fmaxf(state->high[k], mesh->position[i][k]);
        }
    enum orl_result result =
        orl_buf_create(gpu, ORL_OWNER_POINTS, "mesh vertices", mesh->vertex_count * sizeof *mesh->position,
                       mesh->position, &state->vertices);
    if (result == ORL_OK)
        result = orl_buf_create(gpu, ORL_OWNER_POINTS, "mesh triangles",
                                mesh->triangle_count * sizeof *mesh->triangle, mesh->triangle,
                                &state->indices);
    return result;
}

static enum orl_result create(struct orl_gpu *gpu, const struct orl_scene *scene, void **out)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct mesh_state *state = orl_array(log, 1, sizeof *state);
    char *path = orl_scene_mesh_path(log, scene);
    enum orl_result result = state && path ? ORL_OK : ORL_ERR_MEMORY;
    *out = state;
    if (result == ORL_OK && !orl_path_is_file(path))
        result = orl_fail(log, ORL_ERR_NOT_FOUND,
                          "%s: not there; oriel import --mesh makes a scene with a mesh", path);
    if (result == ORL_OK)
        result = orl_mesh_read(log, path, &state->mesh);
    if (result == ORL_OK)
        result = upload(gpu, state);
    if (result != ORL_OK)
        destroy(gpu, out);
    free(path);
    return result;
}

static void free_target(struct orl_gpu *gpu, void **handle)
{
    struct mesh_target *target = *handle;
    if (!target)
        return;
    orl_tex_destroy(gpu, &target->depth);
    orl_tex_destroy(gpu, &target->normal);
    orl_tex_destroy(gpu, &target->test);
    free(target);
    *handle = NULL;
}

static enum orl_result resize(struct orl_gpu *gpu, const void *state, int width, int height,
                              void **out)
{
    struct mesh_target *target = *out;
    (void)state;
    if (target && target->width == width && target->height == height)
        return ORL_OK;
    free_target(gpu, out);
    target = orl_array(orl_gpu_log(gpu), 1, sizeof *target);
    *out = target;
    if (!target)
        return ORL_ERR_MEMORY;
    target->width = width;
    target->height = height;
    const struct {
        const char *tag;
        GLenum format;
        struct orl_tex **tex;
    } rows[] = {
        {"proxy depth", GL_R32F, &target->depth},
        {"proxy normal", GL_RGBA16F, &target->normal},
        {"mesh depth test", GL_DEPTH_COMPONENT32F, &target->test},
    };
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(rows); i++) {
        struct orl_tex_params params = {.width = width, .height = height,
                                        .format = rows[i].format, .tag = rows[i].tag};
        result = orl_tex_create(gpu, &params, rows[i].tex);
    }
    if (result != ORL_OK)
        free_target(gpu, out);
    return result;
}

static size_t target_bytes(const void *state, int width, int height)
{
    (void)state;
    return (size_t)width * (size_t)height * (4 + 8 + 4);
}

// Nearest depth that the bounding box may have before the camera; a small share of the farthest
// where the camera stands within it.
static float nearest(const struct mesh_state *state, const struct orl_view *view)
{
    double low = INFINITY, high = 0;
    for (int corner = 0; corner < 8; corner++) {
        double world[3], q[3];
        for (int k = 0; k < 3; k++)
            world[k] = (double)(corner >> k & 1 ? state->high[k] : state->low[k]);
        orl_pose_apply(&view->cam_from_world, world, q);
        low = fmin(low, q[2]);
        high = fmax(high, q[2]);
    }
    return (float)fmax(0.999 * low, 1e-4 * high);
}

static void draw(struct orl_gpu *gpu, const void *handle, const struct orl_view *view,
                 const struct orl_render_params *params, bool normals, void *memory,
                 struct surface *surface)
{
    const struct mesh_state *state = handle;
    struct mesh_target *target = memory;
    struct mesh_block block = {.view_size = {target->width, target->height},
                               .depth_near = nearest(state, view)};
    double eye[3];
    (void)params, (void)normals; // nothing to choose, and normals come along
    orl_pose_centre(&view->cam_from_world, eye);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            block.rotation[i][j] = (float)view->cam_from_world.r[i][j];
        block.eye[i] = (float)eye[i];
    }
    orl_set_focal(&view->camera, block.focal);
    const struct orl_raster raster = {
        .prog = orl_prog_get_raster(gpu, "proxy/mesh.vert", "proxy/mesh.frag", NULL),
        .params = &block, .params_size = sizeof block,
        .inputs = {{state->vertices, 0, 3 * sizeof(float), 3, GL_FLOAT}},
        .indices = state->indices, .primitive = GL_TRIANGLES, .count = 3 * state->mesh.triangle_count,
        .targets = {target->depth, target->normal}, .depth = target->test,
        .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT,
    };
    orl_pass_begin(gpu, "mesh");
    orl_gpu_raster(gpu, &raster);
    orl_pass_end(gpu);
    *surface = (struct surface){.width = target->width, .height = target->height,
                                .depth = target->depth, .normal = target->normal};
}

const struct proxy_kind orl_proxy_mesh = {
    .name = "mesh", .create = create, .vertices = vertices, .destroy = destroy, .resize = resize,
    .free_target = free_target, .target_bytes = target_bytes, .draw = draw,
};
