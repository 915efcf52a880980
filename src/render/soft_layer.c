#include "render/soft_layer.h"

#include <stdlib.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/manifest.h"
#include "soft/soft_ply.h"

bool orl_soft_layer_shows(const struct frame *frame)
{
    return frame->params->soft > 0 && !frame->radiance;
}

static enum orl_result load(const struct frame *frame, struct soft_layer *layer)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    struct orl_soft_model model = {0};
    char *path = orl_format(log, "%s/%s", frame->scene->dir, ORL_SOFT_NAME);
    enum orl_result result = path ? ORL_OK : ORL_ERR_MEMORY;
    if (path && !orl_path_is_file(path))
        result = orl_fail(log, ORL_ERR_NOT_FOUND, "%s: missing; oriel refine %s makes it, and --set soft=0 draws without", path, frame->scene->dir);
    ORL_THEN(result, orl_soft_read(log, path, &model));
    ORL_THEN(result, orl_soft_raster_init(frame->gpu, &model, &layer->raster));
    orl_soft_finish(&model);
    free(path);
    return result;
}

enum orl_result orl_soft_layer_mix(const struct frame *frame, struct soft_layer *layer)
{
    struct orl_gpu *gpu = frame->gpu;
    struct soft_block block;
    if (!layer->raster.splats)
        ORL_TRY(load(frame, layer));
    orl_pass_begin(gpu, "soft splats");
    enum orl_result result = orl_soft_raster_draw(gpu, &layer->raster, frame->view, true, &block);
    if (result == ORL_OK) {
        block.mix_share = frame->params->soft;
        struct orl_dispatch d = {
            .prog = orl_prog_get(gpu, "soft/mix.comp", NULL, frame->finishes ? "FINISHED" : NULL),
            .params = &block, .params_size = sizeof block,
            .images = {{layer->raster.blended, 0, GL_READ_ONLY}, {frame->picture, 0, GL_READ_WRITE}},
            .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT};
        orl_pixel_groups(frame->surface.width, frame->surface.height, d.groups);
        orl_gpu_dispatch(gpu, &d);
    }
    orl_pass_end(gpu);
    return result;
}

void orl_soft_layer_finish(struct orl_gpu *gpu, struct soft_layer *layer)
{
    orl_soft_raster_finish(gpu, &layer->raster);
}
