// Proxies made of silhouettes. `voxels`: each voxel at the surface is a square parallel to the image
// plane, wide enough to cover it from any side (Goldluecke 2003, section 3). `hull`: their visual hull as
// a mesh (Li 2003, section 4). The paper intersects cones; here the surface is found on a grid of voxels,
// at the distance from the cones.
#include "render/hull/voxels.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "gpu/raster.h"
#include "render/hull/prefetch.h"
#include "render/photos/photos.h"
#include "shared/hull_blocks.h"

static void forget(struct orl_gpu *gpu, void *handle)
{
    struct voxel_state *state = handle;
    orl_mesh_state_finish(gpu, &state->mesh);
    orl_buf_destroy(gpu, &state->centres);
    orl_voxels_finish(&state->voxels);
    free(state->seen);
    *state = (struct voxel_state){.said_endless = state->said_endless};
}

// Takes the voxels, and with `hull` their mesh, from what was prepared for the frame, or makes them.
static enum orl_result make(const struct frame *frame, struct voxel_state *state, bool hull)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    struct voxels *voxels = &state->voxels;
    struct orl_mesh *mesh = hull ? &state->mesh.mesh : NULL;
    if (!orl_prefetch_take_hull(frame->gpu, frame->prefetch, state->key, voxels, mesh)) {
        ORL_TRY(orl_voxels_make(frame, hull, voxels));
        if (hull)
            ORL_TRY(orl_hull_field_mesh(log, &voxels->cube, voxels->field, 0, mesh));
    }
    if (voxels->cube.endless && !state->said_endless)
        orl_hull_warn_endless(log);
    state->said_endless = state->said_endless || voxels->cube.endless;
    if (!hull && !voxels->count)
        return orl_fail(log, ORL_ERR_DATA, "%s: no voxel is left", frame->scene->dir);
    return ORL_OK;
}

static enum orl_result upload(struct orl_gpu *gpu, struct voxel_state *state, bool hull)
{
    struct voxels *voxels = &state->voxels;
    if (!hull)
        return orl_buf_create(gpu, ORL_OWNER_POINTS, "voxel centres",
                              voxels->count * sizeof *voxels->centre, voxels->centre, 0,
                              &state->centres);
    orl_voxels_finish(voxels); // the mesh is all that is drawn
    return orl_mesh_state_upload(gpu, &state->mesh);
}

static enum orl_result update(const struct frame *frame, void *handle, bool *changed)
{
    struct voxel_state *state = handle;
    bool hull = frame->proxy->kind == &orl_proxy_hull;
    uint64_t key = orl_voxels_key(frame);
    if ((state->centres || state->mesh.vertices) && state->key == key)
        return ORL_OK;
    forget(frame->gpu, state);
    state->key = key;
    *changed = true;
    orl_pass_begin(frame->gpu, "hull");
    enum orl_result result = make(frame, state, hull);
    ORL_THEN(result, upload(frame->gpu, state, hull));
    orl_pass_end(frame->gpu);
    if (result != ORL_OK)
        forget(frame->gpu, state);
    return result;
}

const struct orl_proxy_kind orl_proxy_hull = {
    .name = "hull", .state_size = sizeof(struct voxel_state), .update = update, .vertices = orl_mesh_vertices,
    .finish = forget,
    .target_size = sizeof(struct raster_target), .make_target = orl_raster_target_make,
    .draw = orl_mesh_draw,
};

static void vertices(const void *handle, const struct orl_scene *scene, const float (**out)[3],
                     size_t *count)
{
    const struct voxel_state *state = handle;
    (void)scene;
    *out = (const float(*)[3])state->voxels.centre;
    *count = state->voxels.count;
}

double orl_billboard_width(const struct voxel_state *state)
{
    return sqrt(3) * state->voxels.cube.voxel;
}

static void draw(struct orl_gpu *gpu, const void *handle, const struct orl_view *view,
                 const struct orl_render_params *params, bool normals, void *memory)
{
    const struct voxel_state *state = handle;
    const struct raster_target *target = memory;
    struct billboard_block block = {
        .view_size = {target->surface.width, target->surface.height},
        .billboard_half = (float)(0.5 * orl_billboard_width(state)),
    };
    (void)params, (void)normals; // a billboard has no normal of its surface
    orl_set_pose(&view->cam_from_world, block.rotation, block.eye);
    orl_set_focal(&view->camera, block.view_focal);
    const struct orl_raster raster = {
        .prog = orl_prog_get_raster(gpu, "hull/billboard.vert", "hull/depth.frag", NULL),
        ORL_PARAMS(block),
        .inputs = {{state->centres, 0, 3 * sizeof(float), 3, GL_FLOAT, true}},
        .count = 6, .instances = state->voxels.count,
        .targets = {target->surface.depth, target->surface.normal}, .depth = target->test,
    };
    orl_pass_begin(gpu, "voxels");
    orl_gpu_raster(gpu, &raster);
    orl_pass_end(gpu);
}

const struct orl_proxy_kind orl_proxy_voxels = {
    .name = "voxels", .state_size = sizeof(struct voxel_state), .update = update, .vertices = vertices,
    .finish = forget,
    .target_size = sizeof(struct raster_target), .make_target = orl_raster_target_make, .draw = draw,
};

// --- which photographs see a voxel ---

static enum orl_result see_from(const struct frame *frame, struct voxel_state *state,
                                size_t photo, struct orl_buf *seen)
{
    struct proxy *proxy = frame->proxy;
    struct orl_view view = {.camera = frame->photos->states[photo].depth_camera,
                            .cam_from_world = frame->scene->photos[photo].view.cam_from_world};
    struct surface surface;
    ORL_TRY(orl_proxy_draw(frame->gpu, proxy, &view, frame->params, false,
                           &proxy->photo_target, &surface));
    struct seen_block block = {.size = {surface.width, surface.height},
                               .voxel_count = (int)state->voxels.count,
                               .words = (int)state->words, .word = (int)(photo / 32),
                               .bit = (int)(photo % 32),
                               .voxel = (float)state->voxels.cube.voxel};
    orl_set_pose(&view.cam_from_world, block.rotation, block.eye);
    orl_set_focal(&view.camera, block.focal);
    orl_gpu_dispatch(frame->gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, "hull/seen.comp", NULL, NULL), ORL_PARAMS(block),
        .bufs = {state->centres, seen}, .images = {surface.depth}, .size = {block.voxel_count}});
    return ORL_OK;
}

enum orl_result orl_voxels_see(const struct frame *frame, struct voxel_state *state)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    struct orl_buf *seen = NULL;
    if (state->seen)
        return ORL_OK;
    state->words = (frame->scene->photo_count + 31) / 32;
    size_t words = 2 * state->words * state->voxels.count;
    state->seen = orl_array(log, words, sizeof *state->seen);
    enum orl_result result =
        state->seen ? orl_buf_create(frame->gpu, ORL_OWNER_FRAME, "what photographs see",
                                     words * sizeof *state->seen, NULL, 0, &seen)
                    : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < frame->scene->photo_count; i++)
        if (frame->photos->states[i].usable)
            result = see_from(frame, state, i, seen);
    if (result == ORL_OK)
        orl_buf_read(seen, words * sizeof *state->seen, state->seen);
    orl_buf_destroy(frame->gpu, &seen);
    if (result != ORL_OK) {
        free(state->seen);
        state->seen = NULL;
    }
    return result;
}
