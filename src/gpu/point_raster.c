// Draws points with the graphics pipeline, for comparison with compute splatting.
#include "gpu/point_raster.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "gpu/internal.h"
#include "gpu/raster.h"

struct vertex {
    float position[3];
    uint8_t color[4];
};

struct orl_point_raster {
    struct orl_gpu *gpu;
    struct orl_buf *vertices;
    struct orl_tex *color, *depth;
    size_t count;
};

static enum orl_result make_vertices(struct orl_point_raster *r, const float (*positions)[3],
                                     const uint8_t (*colors)[3], size_t count)
{
    struct vertex *vertices = orl_array(r->gpu->log, count, sizeof *vertices);
    ORL_TRY_MEMORY(vertices);
    for (size_t i = 0; i < count; i++) {
        memcpy(vertices[i].position, positions[i], sizeof positions[i]);
        memcpy(vertices[i].color, colors[i], sizeof colors[i]);
        vertices[i].color[3] = 255;
    }
    enum orl_result result = orl_buf_create(r->gpu, ORL_OWNER_POINTS, "raster points",
                                            count * sizeof *vertices, vertices, &r->vertices);
    free(vertices);
    return result;
}

enum orl_result orl_point_raster_create(struct orl_gpu *gpu, const float (*positions)[3],
                                        const uint8_t (*colors)[3], size_t count, int width,
                                        int height, struct orl_point_raster **out)
{
    *out = NULL;
    if (count > INT32_MAX)
        return orl_fail(gpu->log, ORL_ERR_UNSUPPORTED, "%zu points are too many", count);
    struct orl_point_raster *r = orl_array(gpu->log, 1, sizeof *r);
    ORL_TRY_MEMORY(r);
    r->gpu = gpu;
    r->count = count;
    struct orl_tex_params params = {.width = width, .height = height, .format = GL_RGBA8,
                                    .tag = "raster colour"};
    enum orl_result result = make_vertices(r, positions, colors, count);
    ORL_THEN(result, orl_tex_create(gpu, &params, &r->color));
    params.format = GL_DEPTH_COMPONENT32F;
    params.tag = "raster depth";
    ORL_THEN(result, orl_tex_create(gpu, &params, &r->depth));
    if (result != ORL_OK)
        orl_point_raster_destroy(&r);
    *out = r;
    return result;
}

void orl_point_raster_destroy(struct orl_point_raster **raster)
{
    struct orl_point_raster *r = *raster;
    if (!r)
        return;
    orl_buf_destroy(r->gpu, &r->vertices);
    orl_tex_destroy(r->gpu, &r->color);
    orl_tex_destroy(r->gpu, &r->depth);
    free(r);
    *raster = NULL;
}

void orl_point_raster_draw(struct orl_point_raster *r, const float clip_from_world[16])
{
    const struct orl_raster draw = {
        .prog = orl_prog_get_raster(r->gpu, "proxy/points.vert", "proxy/points.frag", NULL),
        .params = clip_from_world, .params_size = 16 * sizeof(float),
        .inputs = {{.buf = r->vertices, .stride = sizeof(struct vertex), .components = 3,
                    .type = GL_FLOAT},
                   {.buf = r->vertices, .offset = offsetof(struct vertex, color),
                    .stride = sizeof(struct vertex), .components = 4,
                    .type = GL_UNSIGNED_BYTE}},
        .primitive = GL_POINTS, .count = r->count, .targets = {r->color}, .depth = r->depth,
    };
    orl_pass_begin(r->gpu, "GL_POINTS");
    orl_gpu_raster(r->gpu, &draw);
    orl_pass_end(r->gpu);
}

const struct orl_tex *orl_point_raster_color(const struct orl_point_raster *r)
{
    return r->color;
}
