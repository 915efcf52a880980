#include "soft/soft_raster.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

enum orl_result orl_soft_raster_init(struct orl_gpu *gpu, const struct orl_soft_model *model,
                                     struct orl_soft_raster *raster)
{
    const size_t n = model->count, vec4 = 4 * sizeof(float);
    *raster = (struct orl_soft_raster){.count = n};
    raster->host_bounds = orl_array(orl_gpu_log(gpu), n, sizeof *raster->host_bounds);
    enum orl_result result = raster->host_bounds ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_buf_create(gpu, ORL_OWNER_POINTS, "soft splats", n * sizeof *model->splats, model->splats,
                                    GL_RGBA32F, &raster->splats));
    ORL_THEN(result, orl_buf_create(gpu, ORL_OWNER_POINTS, "projected soft splats", n * ORL_SOFT_SEEN_VEC4S * vec4,
                                    NULL, GL_RGBA32F, &raster->projected));
    ORL_THEN(result, orl_buf_create(gpu, ORL_OWNER_POINTS, "bounds of soft splats", n * sizeof *raster->host_bounds,
                                    NULL, 0, &raster->bounds));
    if (result != ORL_OK)
        orl_soft_raster_finish(gpu, raster);
    return result;
}

void orl_soft_raster_finish(struct orl_gpu *gpu, struct orl_soft_raster *raster)
{
    orl_buf_destroy(gpu, &raster->splats);
    orl_buf_destroy(gpu, &raster->projected);
    orl_buf_destroy(gpu, &raster->bounds);
    orl_buf_destroy(gpu, &raster->listed);
    orl_tex_destroy(gpu, &raster->blended);
    orl_soft_lists_finish(&raster->lists);
    free(raster->host_bounds);
    memset(raster, 0, sizeof *raster);
}

static struct soft_block block_of(const struct orl_soft_raster *raster, const struct orl_view *view)
{
    const struct orl_camera *c = &view->camera;
    struct soft_block block = {
        .focal = {(float)c->fx, (float)c->fy, (float)c->cx, (float)c->cy},
        .view_size = {c->width, c->height},
        .splat_count = (int)raster->count,
        .tiles_across = (int)orl_groups((size_t)c->width, ORL_SOFT_TILE),
    };
    double eye[3];
    orl_pose_centre(&view->cam_from_world, eye);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            block.rotation[i][j] = (float)view->cam_from_world.r[i][j];
        block.eye[i] = (float)eye[i];
    }
    return block;
}

enum orl_result orl_soft_raster_draw(struct orl_gpu *gpu, struct orl_soft_raster *raster,
                                     const struct orl_view *view, bool smooths,
                                     struct soft_block *block)
{
    *block = block_of(raster, view);
    block->smooths = smooths;
    const int width = view->camera.width, height = view->camera.height;
    const struct orl_tex_params target = {.width = width, .height = height, .levels = orl_mip_levels(width, height),
                                          .format = GL_RGBA32F, .linear = true, .tag = "blended soft splats"};
    ORL_TRY(orl_tex_fit(gpu, &target, &raster->blended));
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "soft/project.comp", NULL, NULL), ORL_PARAMS(*block),
        .bufs = {[2] = raster->bounds}, .images = {[2] = &raster->splats->texels, [6] = &raster->projected->texels},
        .size = ORL_SOFT_SIZE(raster->count)});
    orl_buf_read(raster->bounds, raster->count * sizeof *raster->host_bounds, raster->host_bounds);
    ORL_TRY(orl_gpu_finish(gpu)); // what was read is only good if nothing failed
    ORL_TRY(orl_soft_lists_make(orl_gpu_log(gpu), raster->host_bounds, raster->count, width, height,
                                &raster->lists));
    const size_t tiles = raster->lists.tiles, bytes = (tiles + 1 + raster->lists.entries) * sizeof(int);
    ORL_TRY(orl_buf_fit(gpu, ORL_OWNER_POINTS, "lists of soft splats", bytes, GL_R32I, &raster->listed));
    orl_buf_write(raster->listed, 0, bytes, raster->lists.listed);
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "soft/blend.comp", NULL, NULL), ORL_PARAMS(*block),
        .images = {raster->blended, [6] = &raster->projected->texels, &raster->listed->texels},
        .size = ORL_SOFT_SIZE(tiles)});
    return ORL_OK;
}
