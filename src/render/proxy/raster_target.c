// Targets of proxies that the graphics pipeline draws.
#include "render/proxy/raster_target.h"

#include "core/memory.h"

void orl_raster_target_finish(struct orl_gpu *gpu, void *memory)
{
    struct raster_target *target = memory;
    orl_tex_destroy(gpu, &target->surface.depth);
    orl_tex_destroy(gpu, &target->surface.normal);
    orl_tex_destroy(gpu, &target->test);
}

enum orl_result orl_raster_target_make(struct orl_gpu *gpu, const void *state, void *memory)
{
    struct raster_target *target = memory;
    (void)state;
    const struct orl_tex_row rows[] = {
        {"proxy depth", GL_R32F, &target->surface.depth},
        {"proxy normal", GL_RGBA16F, &target->surface.normal},
        {"proxy depth test", GL_DEPTH_COMPONENT32F, &target->test},
    };
    return orl_tex_create_rows(gpu, target->surface.width, target->surface.height, rows, ORL_COUNT(rows));
}

size_t orl_raster_target_bytes(const void *state, int width, int height)
{
    (void)state;
    return (size_t)width * (size_t)height * (4 + 8 + 4);
}
