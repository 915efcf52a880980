// A triangle mesh as the proxy (orl_scene_mesh_path), drawn by the graphics pipeline.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "gpu/raster.h"
#include "render/frame/frame.h"
#include "render/proxy/mesh_proxy.h"
#include "shared/render_blocks.h"

enum { NO_TIME_STEP = -2 }; // a scene's are from -1 on

void orl_mesh_vertices(const void *handle, const struct orl_scene *scene,
                       const float (**out)[3], size_t *count)
{
    const struct mesh_state *state = handle;
    (void)scene;
    *out = (const float(*)[3])state->mesh.position;
    *count = state->mesh.vertex_count;
}

// Colours of three bytes as vertex inputs of four.
static enum orl_result upload_colors(struct orl_gpu *gpu, struct mesh_state *state)
{
    const struct orl_mesh *mesh = &state->mesh;
    if (!mesh->color)
        return ORL_OK;
    uint8_t (*padded)[4] = orl_array(orl_gpu_log(gpu), mesh->vertex_count, sizeof *padded);
    ORL_TRY_MEMORY(padded);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        memcpy(padded[i], mesh->color[i], sizeof *mesh->color);
    enum orl_result result =
        orl_buf_create(gpu, ORL_OWNER_POINTS, "mesh colours",
                       mesh->vertex_count * sizeof *padded, padded, 0, &state->colors);
    free(padded);
    return result;
}

enum orl_result orl_mesh_state_upload(struct orl_gpu *gpu, struct mesh_state *state)
{
    const struct orl_mesh *mesh = &state->mesh;
    memcpy(state->low, mesh->position[0], sizeof state->low);
    memcpy(state->high, mesh->position[0], sizeof state->high);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            state->low[k] = fminf(state->low[k], mesh->position[i][k]);
            state->high[k] = fmaxf(state->high[k], mesh->position[i][k]);
        }
    ORL_TRY(orl_buf_create(gpu, ORL_OWNER_POINTS, "mesh vertices", mesh->vertex_count * sizeof *mesh->position,
                           mesh->position, 0, &state->vertices));
    ORL_TRY(orl_buf_create(gpu, ORL_OWNER_POINTS, "mesh triangles",
                           mesh->triangle_count * sizeof *mesh->triangle, mesh->triangle, 0,
                           &state->indices));
    return upload_colors(gpu, state);
}

void orl_mesh_state_finish(struct orl_gpu *gpu, void *handle)
{
    struct mesh_state *state = handle;
    orl_buf_destroy(gpu, &state->vertices);
    orl_buf_destroy(gpu, &state->indices);
    orl_buf_destroy(gpu, &state->colors);
    orl_mesh_finish(&state->mesh);
}

// After a failure the state has no mesh, and the next frame asks for one again.
static enum orl_result load(struct orl_gpu *gpu, const struct orl_scene *scene,
                            struct mesh_state *state)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    const struct orl_file_path path = orl_scene_mesh_path(scene);
    orl_mesh_state_finish(gpu, state);
    state->time_step = NO_TIME_STEP;
    if (!orl_path_is_file(path.text))
        return orl_fail(log, ORL_ERR_NOT_FOUND,
                        "%s: not there; --mesh of oriel prepare or oriel import makes one%s", path.text,
                        scene->points.count ? "" : ". The scene has no points, either: --points densify or --points FILE "
                                                   "of oriel import gives it some");
    ORL_TRY(orl_mesh_read(log, path.text, NULL, &state->mesh));
    ORL_TRY(orl_mesh_state_upload(gpu, state));
    state->time_step = scene->frame;
    return ORL_OK;
}

static enum orl_result init(struct orl_gpu *gpu, const struct orl_scene *scene, size_t max_bytes, void *state)
{
    (void)max_bytes; // a mesh is on the device as a whole
    return load(gpu, scene, state);
}

// Time steps of a sequence may have meshes of their own.
static enum orl_result update(const struct frame *frame, void *handle, bool *changed)
{
    struct mesh_state *state = handle;
    *changed = state->time_step != frame->scene->frame;
    return *changed ? load(frame->gpu, frame->scene, state) : ORL_OK;
}

void orl_mesh_range(const struct mesh_state *state, const struct orl_view *view, float *near,
                    float *far)
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
    // Where the camera stands within the box, or has it behind, any range ahead will do.
    *far = high > 0 ? (float)(1.001 * high) : 1;
    *near = (float)fmax(0.999 * low, 1e-4 * (double)*far);
}

enum orl_result orl_raster_target_make(struct orl_gpu *gpu, const void *state, void *memory)
{
    struct raster_target *target = memory;
    (void)state;
    const struct orl_tex_row row = {"proxy depth test", GL_DEPTH_COMPONENT32F, &target->test};
    return orl_tex_create_rows(gpu, target->surface.width, target->surface.height, &row, 1);
}

// Draws into two pictures, or with the colours of the vertices into one.
static void draw_into(struct orl_gpu *gpu, const struct mesh_state *state, const struct orl_view *view,
                      const struct raster_target *target, bool colors, const struct orl_tex *first,
                      const struct orl_tex *second)
{
    struct mesh_block block = {.view_size = {target->surface.width, target->surface.height}};
    orl_mesh_range(state, view, &block.depth_near, &block.depth_far);
    orl_set_pose(&view->cam_from_world, block.rotation, block.eye);
    orl_set_focal(&view->camera, block.focal);
    const struct orl_raster raster = {
        .prog = orl_prog_get_raster(gpu, "proxy/mesh.vert", colors ? "proxy/mesh_color.frag" : "proxy/mesh.frag",
                                    colors ? "COLORS" : NULL),
        ORL_PARAMS(block),
        .inputs = {{.buf = state->vertices, .stride = 3 * sizeof(float), .components = 3, .type = GL_FLOAT},
                   {.buf = colors ? state->colors : NULL, .stride = 4, .components = 4, .type = GL_UNSIGNED_BYTE}},
        .indices = state->indices, .count = 3 * state->mesh.triangle_count,
        .targets = {first, second}, .depth = target->test,
    };
    orl_gpu_raster(gpu, &raster);
}

void orl_mesh_draw(struct orl_gpu *gpu, const void *state, const struct orl_view *view,
                   const struct orl_render_params *params, bool normals, void *memory)
{
    const struct raster_target *target = memory;
    (void)params, (void)normals; // nothing to choose, and normals come along
    orl_pass_begin(gpu, "mesh");
    draw_into(gpu, state, view, target, false, target->surface.depth, target->surface.normal);
    orl_pass_end(gpu);
}

// Draws the mesh again, with the colours of its vertices. Without colours it paints nothing.
static void color(struct orl_gpu *gpu, const void *handle, const struct orl_view *view,
                  const void *target, const struct paint_into *into)
{
    const struct mesh_state *state = handle;
    // The pipeline clears the picture, so samples of photographs could not be kept.
    if (state->colors && !into->only_unpainted)
        draw_into(gpu, state, view, target, true, into->picture, NULL);
}

const struct orl_proxy_kind orl_proxy_mesh = {
    .name = "mesh", .state_size = sizeof(struct mesh_state), .init = init, .update = update,
    .vertices = orl_mesh_vertices, .finish = orl_mesh_state_finish,
    .target_size = sizeof(struct raster_target), .make_target = orl_raster_target_make,
    .draw = orl_mesh_draw, .color = color,
};
