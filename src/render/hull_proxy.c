// The visual hull of the silhouettes as the proxy, as a mesh (Li 2003, section 4). The paper
// intersects cones; here the surface is found on a grid of voxels, at the distance from the cones.
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/prefetch.h"
#include "render/mesh_proxy.h"
#include "render/raster_target.h"

struct hull_state {
    struct mesh_state mesh; // first: see mesh_proxy.h
    uint64_t key;           // of what the mesh was made of
    bool said_endless;
};

static enum orl_result create(struct orl_gpu *gpu, const struct orl_scene *scene,
                              size_t max_bytes, void **out)
{
    (void)scene, (void)max_bytes; // update makes the mesh
    *out = orl_array(orl_gpu_log(gpu), 1, sizeof(struct hull_state));
    return *out ? ORL_OK : ORL_ERR_MEMORY;
}

static void forget(struct orl_gpu *gpu, struct hull_state *state)
{
    orl_mesh_state_finish(gpu, &state->mesh);
    *state = (struct hull_state){.said_endless = state->said_endless};
}

static void destroy(struct orl_gpu *gpu, void **handle)
{
    if (!*handle)
        return;
    forget(gpu, *handle);
    free(*handle);
    *handle = NULL;
}

static enum orl_result make(const struct frame *frame, struct hull_state *state)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    struct voxels voxels = {0};
    enum orl_result result = ORL_OK;
    if (!orl_voxels_silhouettes(frame))
        return orl_fail(log, ORL_ERR_NOT_FOUND,
                        "%s: no silhouettes to make a hull of; see oriel import",
                        frame->scene->dir);
    if (!orl_prefetch_take_hull(frame->gpu, frame->prefetch, orl_voxels_key(frame), &voxels,
                                &state->mesh.mesh)) {
        result = orl_voxels_make(frame, &voxels);
        if (result == ORL_OK)
            result = orl_hull_field_mesh(log, &voxels.cube, voxels.field, 0,
                                         &state->mesh.mesh);
    }
    orl_voxels_warn(log, &voxels, &state->said_endless);
    orl_voxels_finish(&voxels);
    return result == ORL_OK ? orl_mesh_state_upload(frame->gpu, &state->mesh) : result;
}

static enum orl_result update(const struct frame *frame, void *handle, bool *changed)
{
    struct hull_state *state = handle;
    uint64_t key = orl_voxels_key(frame);
    if (state->mesh.vertices && state->key == key)
        return ORL_OK;
    forget(frame->gpu, state);
    *changed = true;
    orl_pass_begin(frame->gpu, "hull");
    enum orl_result result = make(frame, state);
    orl_pass_end(frame->gpu);
    state->key = key;
    if (result != ORL_OK)
        forget(frame->gpu, state);
    return result;
}

const struct orl_proxy_kind orl_proxy_hull = {
    .name = "hull", .create = create, .update = update, .vertices = orl_mesh_vertices,
    .destroy = destroy, .resize = orl_raster_target_resize,
    .free_target = orl_raster_target_free, .target_bytes = orl_raster_target_bytes,
    .draw = orl_mesh_draw,
};
