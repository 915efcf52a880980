// Depth from points: compute splatting, then pull-push (Airieau 2012, 5.1).
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/internal.h"

// 4 Mi points are 64 MiB of positions: half of what the smallest device binds, and
// within the 65535 work groups that one dispatch may have.
enum { CHUNK_POINTS = 4 << 20 };

void orl_pixel_groups(int width, int height, unsigned groups[3])
{
    groups[0] = orl_groups((size_t)width, ORL_PIXEL_GROUP_X);
    groups[1] = orl_groups((size_t)height, ORL_PIXEL_GROUP_Y);
    groups[2] = 1;
}

static uint32_t pack_snorm(double value)
{
    return (uint32_t)(uint16_t)(int16_t)lrint(fmin(1, fmax(-1, value)) * 32767);
}

// As shaders/include/octahedron.glsl; two 16-bit snorm.
static uint32_t pack_normal(const float n[3])
{
    double x = n[0], y = n[1], z = n[2];
    double sum = fabs(x) + fabs(y) + fabs(z);
    if (!(sum > 0))
        return pack_snorm(0) | pack_snorm(0) << 16;
    x /= sum, y /= sum;
    if (z < 0) {
        double wrapped = (1 - fabs(y)) * (x >= 0 ? 1 : -1);
        y = (1 - fabs(x)) * (y >= 0 ? 1 : -1);
        x = wrapped;
    }
    return pack_snorm(x) | pack_snorm(y) << 16;
}

static enum orl_result upload_chunk(struct orl_gpu *gpu, const struct orl_points *points,
                                    struct point_chunk *chunk)
{
    size_t count = (size_t)chunk->count, first = (size_t)chunk->first;
    float(*positions)[4] = orl_array(orl_gpu_log(gpu), count, sizeof *positions);
    uint32_t(*attributes)[2] = orl_array(orl_gpu_log(gpu), count, sizeof *attributes);
    enum orl_result result = positions && attributes ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        memcpy(positions[i], points->position[first + i], 3 * sizeof(float));
        positions[i][3] = points->radius[first + i];
        const uint8_t *c = points->color[first + i];
        attributes[i][0] = pack_normal(points->normal[first + i]);
        attributes[i][1] = (uint32_t)c[0] | (uint32_t)c[1] << 8 | (uint32_t)c[2] << 16 |
                           0xff000000u;
    }
    if (result == ORL_OK)
        result = orl_buf_create(gpu, "point positions", count * sizeof *positions, positions,
                                &chunk->positions);
    if (result == ORL_OK)
        result = orl_buf_create(gpu, "point attributes", count * sizeof *attributes, attributes,
                                &chunk->attributes);
    free(positions);
    free(attributes);
    return result;
}

static enum orl_result upload_points(struct orl_gpu *gpu, const struct orl_points *points,
                                     struct proxy *proxy)
{
    if (points->count > INT32_MAX)
        return orl_fail(orl_gpu_log(gpu), ORL_ERR_UNSUPPORTED, "%zu points are too many",
                        points->count);
    size_t chunks = (points->count + CHUNK_POINTS - 1) / CHUNK_POINTS;
    proxy->chunks = orl_array(orl_gpu_log(gpu), chunks, sizeof *proxy->chunks);
    if (!proxy->chunks)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < chunks; i++) {
        struct point_chunk *chunk = &proxy->chunks[proxy->chunk_count++];
        size_t first = i * CHUNK_POINTS, rest = points->count - first;
        chunk->first = (int)first;
        chunk->count = rest < CHUNK_POINTS ? (int)rest : CHUNK_POINTS;
        result = upload_chunk(gpu, points, chunk);
    }
    return result;
}

enum orl_result orl_proxy_init(struct orl_gpu *gpu, const struct orl_points *points,
                               struct proxy *proxy)
{
    memset(proxy, 0, sizeof *proxy);
    const struct {
        const char *file;
        size_t params_size;
        struct orl_prog **prog;
    } programs[] = {
        {"splat_depth.comp", sizeof(struct splat_block), &proxy->splat_depth},
        {"splat_index.comp", sizeof(struct splat_block), &proxy->splat_index},
        {"splat_resolve.comp", sizeof(struct splat_block), &proxy->splat_resolve},
        {"pull.comp", sizeof(struct pyramid_block), &proxy->pull},
        {"push.comp", sizeof(struct pyramid_block), &proxy->push},
        {"proxy_output.comp", sizeof(struct pyramid_block), &proxy->output},
    };
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(programs); i++)
        result = orl_prog_create(gpu, programs[i].file, NULL, programs[i].params_size,
                                 programs[i].prog);
    if (result == ORL_OK)
        result = upload_points(gpu, points, proxy);
    if (result != ORL_OK)
        orl_proxy_finish(gpu, proxy);
    return result;
}

void orl_proxy_finish(struct orl_gpu *gpu, struct proxy *proxy)
{
    for (size_t i = 0; i < proxy->chunk_count; i++) {
        orl_buf_destroy(gpu, &proxy->chunks[i].positions);
        orl_buf_destroy(gpu, &proxy->chunks[i].attributes);
    }
    free(proxy->chunks);
    orl_prog_destroy(gpu, &proxy->splat_depth);
    orl_prog_destroy(gpu, &proxy->splat_index);
    orl_prog_destroy(gpu, &proxy->splat_resolve);
    orl_prog_destroy(gpu, &proxy->pull);
    orl_prog_destroy(gpu, &proxy->push);
    orl_prog_destroy(gpu, &proxy->output);
    memset(proxy, 0, sizeof *proxy);
}

// Pyramid levels: enough for discs of some 2^8 pixels; finer than that no point cloud
// made from photographs is.
static int pyramid_levels(int width, int height)
{
    int levels = 1;
    for (int side = width > height ? width : height; side > 1; side /= 2)
        levels++;
    return levels < PYRAMID_LEVELS_MAX ? levels : PYRAMID_LEVELS_MAX;
}

// Rounded up so that every level halves exactly and no pixel is lost.
static int padded(int side, int levels)
{
    int unit = 1 << (levels - 1);
    return (side + unit - 1) / unit * unit;
}

size_t orl_proxy_target_bytes(int width, int height)
{
    int levels = pyramid_levels(width, height);
    size_t pyramid = (size_t)padded(width, levels) * (size_t)padded(height, levels) * 32;
    return pyramid + pyramid / 3 + (size_t)width * (size_t)height * (16 + 4 + 4 + 8);
}

static enum orl_result make_pyramid(struct orl_gpu *gpu, struct proxy_target *t)
{
    int width = padded(t->width, t->levels), height = padded(t->height, t->levels);
    enum orl_result result = ORL_OK;
    for (int i = 0; result == ORL_OK && i < t->levels; i++) {
        struct orl_tex_params params = {.width = width >> i, .height = height >> i,
                                        .format = GL_RGBA32F, .tag = "surfel pyramid"};
        result = orl_tex_create(gpu, &params, &t->surfel_a[i]);
        if (result == ORL_OK)
            result = orl_tex_create(gpu, &params, &t->surfel_b[i]);
    }
    return result;
}

enum orl_result orl_proxy_target_resize(struct orl_gpu *gpu, struct proxy_target *target, int width,
                                        int height)
{
    if (target->width == width && target->height == height)
        return ORL_OK;
    orl_proxy_target_finish(gpu, target);
    target->width = width;
    target->height = height;
    target->levels = pyramid_levels(width, height);
    size_t words = (size_t)width * (size_t)height * 4;
    struct orl_tex_params params = {.width = width, .height = height};
    enum orl_result result = make_pyramid(gpu, target);
    if (result == ORL_OK)
        result = orl_buf_create(gpu, "splat depth", words, NULL, &target->depth_bits);
    if (result == ORL_OK)
        result = orl_buf_create(gpu, "splat index", words, NULL, &target->point_index);
    if (result == ORL_OK)
        result = orl_buf_create(gpu, "splat layer", 2 * words, NULL, &target->layer);
    params.format = GL_RGBA8;
    params.tag = "splat colour";
    if (result == ORL_OK)
        result = orl_tex_create(gpu, &params, &target->splat_color);
    params.format = GL_R32F;
    params.tag = "proxy depth";
    if (result == ORL_OK)
        result = orl_tex_create(gpu, &params, &target->depth);
    params.format = GL_RGBA16F;
    params.tag = "proxy normal";
    if (result == ORL_OK)
        result = orl_tex_create(gpu, &params, &target->normal);
    if (result != ORL_OK)
        orl_proxy_target_finish(gpu, target);
    return result;
}

void orl_proxy_target_finish(struct orl_gpu *gpu, struct proxy_target *target)
{
    for (int i = 0; i < PYRAMID_LEVELS_MAX; i++) {
        orl_tex_destroy(gpu, &target->surfel_a[i]);
        orl_tex_destroy(gpu, &target->surfel_b[i]);
    }
    orl_buf_destroy(gpu, &target->depth_bits);
    orl_buf_destroy(gpu, &target->point_index);
    orl_buf_destroy(gpu, &target->layer);
    orl_tex_destroy(gpu, &target->splat_color);
    orl_tex_destroy(gpu, &target->depth);
    orl_tex_destroy(gpu, &target->normal);
    memset(target, 0, sizeof *target);
}

static struct splat_block splat_params(const struct orl_view *view,
                                       const struct proxy_options *options)
{
    struct splat_block block = {.options = {options->splat_scale, options->front_layer}};
    double eye[3];
    orl_pose_centre(&view->cam_from_world, eye);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            block.rotation[i][j] = (float)view->cam_from_world.r[i][j];
        block.eye[i] = (float)eye[i];
    }
    block.focal[0] = (float)view->camera.fx;
    block.focal[1] = (float)view->camera.fy;
    block.focal[2] = (float)view->camera.cx;
    block.focal[3] = (float)view->camera.cy;
    block.size[0] = view->camera.width;
    block.size[1] = view->camera.height;
    return block;
}

static void splat(struct orl_gpu *gpu, const struct proxy *proxy, const struct orl_view *view,
                  const struct proxy_options *options, struct proxy_target *t)
{
    struct splat_block block = splat_params(view, options);
    orl_buf_fill(t->depth_bits, UINT32_MAX);
    orl_buf_fill(t->point_index, UINT32_MAX);
    orl_buf_fill(t->layer, 0);
    orl_tex_clear(t->surfel_a[0], 0);
    orl_tex_clear(t->splat_color, 0);
    struct orl_prog *const passes[] = {proxy->splat_depth, proxy->splat_index};
    for (size_t pass = 0; pass < ORL_COUNT(passes); pass++)
        for (size_t i = 0; i < proxy->chunk_count; i++) {
            const struct point_chunk *chunk = &proxy->chunks[i];
            block.size[2] = chunk->count;
            block.size[3] = chunk->first;
            struct orl_dispatch d = {.prog = passes[pass], .params = &block,
                                     .bufs = {{.buf = chunk->positions}, {.buf = t->depth_bits},
                                              {.buf = t->point_index}, {.buf = t->layer}},
                                     .groups = {orl_groups((size_t)chunk->count, ORL_POINT_GROUP)},
                                     .barrier = GL_SHADER_STORAGE_BARRIER_BIT};
            orl_gpu_dispatch(gpu, &d);
        }
    for (size_t i = 0; i < proxy->chunk_count; i++) {
        const struct point_chunk *chunk = &proxy->chunks[i];
        block.size[2] = chunk->count;
        block.size[3] = chunk->first;
        struct orl_dispatch d = {.prog = proxy->splat_resolve, .params = &block,
                                 .bufs = {{.buf = chunk->positions}, {.buf = NULL},
                                          {.buf = t->point_index}, {.buf = chunk->attributes},
                                          {.buf = t->layer}},
                                 .images = {{t->surfel_a[0], 0, GL_WRITE_ONLY},
                                            {t->surfel_b[0], 0, GL_WRITE_ONLY},
                                            {t->splat_color, 0, GL_WRITE_ONLY}},
                                 .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT};
        orl_pixel_groups(t->width, t->height, d.groups);
        orl_gpu_dispatch(gpu, &d);
    }
}

// Level `written` from level `other`, by pull (other is finer) or push (coarser).
static void pyramid_step(struct orl_gpu *gpu, struct orl_prog *prog, struct pyramid_block *block,
                         struct proxy_target *t, int written, int other)
{
    bool pull = other < written;
    int fine = pull ? other : written, coarse = pull ? written : other;
    const struct orl_tex *out = t->surfel_a[written];
    block->level[0] = out->params.width;
    block->level[1] = out->params.height;
    block->level[2] = written;
    GLenum fine_access = pull ? GL_READ_ONLY : GL_READ_WRITE;
    GLenum coarse_access = pull ? GL_WRITE_ONLY : GL_READ_ONLY;
    struct orl_dispatch d = {.prog = prog, .params = block,
                             .images = {{t->surfel_a[fine], 0, fine_access},
                                        {t->surfel_b[fine], 0, fine_access},
                                        {t->surfel_a[coarse], 0, coarse_access},
                                        {t->surfel_b[coarse], 0, coarse_access}},
                             .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT};
    if (pull)
        orl_pixel_groups(out->params.width, out->params.height, d.groups);
    else // one invocation per corner of the coarse level's pixels
        orl_pixel_groups(t->surfel_a[coarse]->params.width + 1,
                         t->surfel_a[coarse]->params.height + 1, d.groups);
    orl_gpu_dispatch(gpu, &d);
}

static void pull_push(struct orl_gpu *gpu, const struct proxy *proxy, const struct orl_view *view,
                      const struct proxy_options *options, struct proxy_target *t)
{
    struct pyramid_block block = {.camera = {(float)view->camera.fx, (float)view->camera.fy,
                                             (float)view->camera.cx, (float)view->camera.cy}};
    for (int i = 1; i < t->levels; i++)
        pyramid_step(gpu, proxy->pull, &block, t, i, i - 1);
    for (int i = t->levels - 2; i >= 0; i--)
        pyramid_step(gpu, proxy->push, &block, t, i, i + 1);
    block.level[0] = t->width;
    block.level[1] = t->height;
    block.level[2] = 0;
    block.level[3] = (int)options->min_support;
    struct orl_dispatch d = {.prog = proxy->output, .params = &block,
                             .images = {{t->surfel_a[0], 0, GL_READ_ONLY},
                                        {t->surfel_b[0], 0, GL_READ_ONLY},
                                        {t->depth, 0, GL_WRITE_ONLY},
                                        {t->normal, 0, GL_WRITE_ONLY}},
                             .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                        GL_TEXTURE_FETCH_BARRIER_BIT};
    orl_pixel_groups(t->width, t->height, d.groups);
    orl_gpu_dispatch(gpu, &d);
}

void orl_proxy_draw(struct orl_gpu *gpu, const struct proxy *proxy, const struct orl_view *view,
                    const struct proxy_options *options, struct proxy_target *target)
{
    orl_pass_begin(gpu, "splat");
    splat(gpu, proxy, view, options, target);
    orl_pass_end(gpu);
    orl_pass_begin(gpu, "pull-push");
    pull_push(gpu, proxy, view, options, target);
    orl_pass_end(gpu);
}
