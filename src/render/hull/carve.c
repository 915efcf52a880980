// Carves voxels with the cones of silhouettes on the device.
#include <math.h>
#include <string.h>

#include "render/hull/voxels.h"
#include "shared/hull_blocks.h"

static struct carve_block carve_params(const struct cone *cone, const struct orl_hull *cube)
{
    const struct orl_view *view = &cone->view;
    double origin[3];
    struct carve_block block = {.size = {view->camera.width, view->camera.height}, .side = cube->side,
                                .open = cone->open, .most = (float)(ORL_CONES_MAX * cube->voxel)};
    orl_set_focal(&view->camera, block.focal);
    orl_pose_apply(&view->cam_from_world, cube->origin, origin);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            block.camera_from_voxels[i][j] = (float)(view->cam_from_world.r[i][j] * cube->voxel);
        block.camera_from_voxels[i][3] = (float)origin[i];
    }
    return block;
}

static enum orl_result carve_one(struct orl_gpu *gpu, const struct cone *cone,
                                 const struct carve_block *block, size_t voxels,
                                 struct orl_buf *field)
{
    struct orl_tex *tex = NULL;
    const struct orl_tex_params params = {.width = cone->distance.width,
                                          .height = cone->distance.height, .format = GL_R32F,
                                          .linear = true, .tag = "silhouette"};
    ORL_TRY(orl_tex_create(gpu, &params, &tex));
    orl_tex_write(tex, GL_RED, GL_FLOAT, cone->distance.data);
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "hull/carve.comp", NULL, NULL), ORL_PARAMS(*block),
        .bufs = {field}, .textures = {tex}, .size = {(int)voxels}});
    orl_tex_destroy(gpu, &tex);
    return ORL_OK;
}

enum orl_result orl_cones_carve(struct orl_gpu *gpu, const struct cones *cones,
                                struct orl_buf **field)
{
    const float unlimited = -INFINITY; // no silhouette has limited a voxel yet
    size_t voxels = orl_hull_voxels(&cones->cube);
    uint32_t word;
    *field = NULL;
    ORL_TRY(orl_buf_create(gpu, ORL_OWNER_FRAME, "voxels", voxels * sizeof(float), NULL, 0, field));
    memcpy(&word, &unlimited, sizeof word);
    orl_buf_fill(*field, word);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < cones->count; i++) {
        struct carve_block block = carve_params(&cones->all[i], &cones->cube);
        result = carve_one(gpu, &cones->all[i], &block, voxels, *field);
    }
    if (result != ORL_OK)
        orl_buf_destroy(gpu, field);
    return result;
}
