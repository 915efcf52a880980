// Targets of proxies that the graphics pipeline draws.
#include "render/proxy/raster_target.h"

#include <stdlib.h>

#include "core/memory.h"

void orl_raster_target_free(struct orl_gpu *gpu, void **handle)
{
    struct raster_target *target = *handle;
    if (!target)
        return;
    orl_tex_destroy(gpu, &target->depth);
    orl_tex_destroy(gpu, &target->normal);
    orl_tex_destroy(gpu, &target->test);
    free(target);
    *handle = NULL;
}

enum orl_result orl_raster_target_resize(struct orl_gpu *gpu, const void *state, int width,
                                         int height, void **out)
{
    struct raster_target *target = *out;
    (void)state;
    if (target && target->width == width && target->height == height)
        return ORL_OK;
    orl_raster_target_free(gpu, out);
    target = orl_array(orl_gpu_log(gpu), 1, sizeof *target);
    *out = target;
    ORL_TRY_MEMORY(target);
    target->width = width;
    target->height = height;
    const struct orl_tex_row rows[] = {
        {"proxy depth", GL_R32F, &target->depth},
        {"proxy normal", GL_RGBA16F, &target->normal},
        {"proxy depth test", GL_DEPTH_COMPONENT32F, &target->test},
    };
    enum orl_result result = orl_tex_create_rows(gpu, width, height, rows, ORL_COUNT(rows));
    if (result != ORL_OK)
        orl_raster_target_free(gpu, out);
    return result;
}

size_t orl_raster_target_bytes(const void *state, int width, int height)
{
    (void)state;
    return (size_t)width * (size_t)height * (4 + 8 + 4);
}
