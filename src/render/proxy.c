// Depth from points: compute splatting, then pull-push (Airieau 2012, 5.1).
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "render/internal.h"

void orl_pixel_groups(int width, int height, unsigned groups[3])
{
    groups[0] = orl_groups((size_t)width, ORL_PIXEL_GROUP_X);
    groups[1] = orl_groups((size_t)height, ORL_PIXEL_GROUP_Y);
    groups[2] = 1;
}

enum orl_result orl_proxy_init(struct orl_gpu *gpu, const struct orl_points *points,
                               struct proxy *proxy)
{
    memset(proxy, 0, sizeof *proxy);
    const struct {
        const char *file, *defines;
        size_t params_size;
        struct orl_prog **prog;
    } programs[] = {
        {"proxy/splat_depth.comp", NULL, sizeof(struct splat_block), &proxy->splat_depth},
        {"proxy/splat_index.comp", NULL, sizeof(struct splat_block), &proxy->splat_index},
        {"proxy/splat_resolve.comp", NULL, sizeof(struct splat_block), &proxy->resolve[0]},
        {"proxy/splat_resolve.comp", "NORMALS", sizeof(struct splat_block), &proxy->resolve[1]},
        {"proxy/splat_resolve.comp", "CHUNKS", sizeof(struct splat_block), &proxy->resolve_chunk[0]},
        {"proxy/splat_resolve.comp", "CHUNKS 1\nNORMALS", sizeof(struct splat_block),
         &proxy->resolve_chunk[1]},
        {"proxy/points_color.comp", NULL, sizeof(struct splat_block), &proxy->color},
        {"proxy/pull.comp", NULL, sizeof(struct pyramid_block), &proxy->pull},
        {"proxy/push.comp", NULL, sizeof(struct pyramid_block), &proxy->push},
        {"proxy/push.comp", "LAST", sizeof(struct pyramid_block), &proxy->push_last[0]},
        {"proxy/push.comp", "LAST 1\nNORMALS", sizeof(struct pyramid_block), &proxy->push_last[1]},
        {"proxy/support.comp", NULL, sizeof(struct pyramid_block), &proxy->support},
    };
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(programs); i++)
        result = orl_prog_create(gpu, programs[i].file, programs[i].defines,
                                 programs[i].params_size, programs[i].prog);
    if (result == ORL_OK)
        result = orl_cloud_init(gpu, points, &proxy->cloud);
    if (result != ORL_OK)
        orl_proxy_finish(gpu, proxy);
    return result;
}

void orl_proxy_finish(struct orl_gpu *gpu, struct proxy *proxy)
{
    orl_cloud_finish(gpu, &proxy->cloud);
    struct orl_prog **const programs[] = {
        &proxy->splat_depth, &proxy->splat_index, &proxy->resolve[0], &proxy->resolve[1],
        &proxy->resolve_chunk[0], &proxy->resolve_chunk[1], &proxy->color, &proxy->pull,
        &proxy->push, &proxy->push_last[0], &proxy->push_last[1], &proxy->support,
    };
    for (size_t i = 0; i < ORL_COUNT(programs); i++)
        orl_prog_destroy(gpu, programs[i]);
    memset(proxy, 0, sizeof *proxy);
}

// Pyramid levels: enough for discs of some 2^8 pixels; finer than that no point cloud
// made from photographs is. At least two: level 0 is made with level 1, and pushed from it.
static int pyramid_levels(int width, int height)
{
    int levels = 2;
    for (int side = width > height ? width : height; side > 2; side /= 2)
        levels++;
    return levels < PYRAMID_LEVELS_MAX ? levels : PYRAMID_LEVELS_MAX;
}

size_t orl_proxy_target_bytes(const struct proxy *proxy, int width, int height)
{
    // Three words a pixel of splats, 8 bytes of level 0, two depths, a normal, and 24 bytes
    // of the coarser levels; four words more between chunks.
    size_t chunks = proxy->cloud.chunk_count < 2 ? 0 : 16;
    return (size_t)width * (size_t)height * (12 + 8 + 8 + 8 + 24 / 3 + chunks);
}

// Each level half as large as the one before, rounded up: loads outside read as empty.
static enum orl_result make_pyramid(struct orl_gpu *gpu, struct proxy_target *t)
{
    enum orl_result result = ORL_OK;
    int width = t->width, height = t->height;
    for (int i = 1; result == ORL_OK && i < t->levels; i++) {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        struct orl_tex_params params = {.width = width, .height = height, .format = GL_RGBA32F,
                                        .tag = "surfel pyramid"};
        result = orl_tex_create(gpu, &params, &t->surfel_a[i]);
        params.format = GL_RG32UI;
        if (result == ORL_OK)
            result = orl_tex_create(gpu, &params, &t->surfel_b[i]);
    }
    return result;
}

enum orl_result orl_proxy_target_resize(struct orl_gpu *gpu, const struct proxy *proxy,
                                        struct proxy_target *target, int width, int height)
{
    if (target->width == width && target->height == height)
        return ORL_OK;
    orl_proxy_target_finish(gpu, target);
    target->width = width;
    target->height = height;
    target->levels = pyramid_levels(width, height);
    const struct {
        const char *tag;
        GLenum format;
        struct orl_tex **tex;
    } rows[] = {
        {"splat depth", GL_R32UI, &target->splat_depth},
        {"splat index", GL_R32UI, &target->splat_index},
        {"splat layer", GL_R32UI, &target->splat_layer},
        {"splats", GL_RG32UI, &target->splats},
        {"splats of chunks", GL_RGBA32UI, &target->chunk_splats},
        {"pushed depth", GL_R32F, &target->pushed_depth},
        {"proxy depth", GL_R32F, &target->depth},
        {"proxy normal", GL_RGBA16F, &target->normal},
    };
    enum orl_result result = make_pyramid(gpu, target);
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(rows); i++) {
        if (rows[i].tex == &target->chunk_splats && proxy->cloud.chunk_count < 2)
            continue;
        struct orl_tex_params params = {.width = width, .height = height,
                                        .format = rows[i].format, .tag = rows[i].tag};
        result = orl_tex_create(gpu, &params, rows[i].tex);
    }
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
    struct orl_tex **const textures[] = {
        &target->splat_depth, &target->splat_index, &target->splat_layer, &target->splats,
        &target->chunk_splats, &target->pushed_depth, &target->depth, &target->normal,
    };
    for (size_t i = 0; i < ORL_COUNT(textures); i++)
        orl_tex_destroy(gpu, textures[i]);
    memset(target, 0, sizeof *target);
}

static struct splat_block splat_params(const struct orl_view *view,
                                       const struct proxy_options *options)
{
    struct splat_block block = {.options = {options->splat_scale, options->front_layer,
                                             options->points_per_pixel}};
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

static void splat(struct orl_gpu *gpu, const struct proxy *proxy, struct splat_block *block,
                  struct proxy_target *t)
{
    orl_tex_fill(t->splat_depth, UINT32_MAX);
    orl_tex_fill(t->splat_index, UINT32_MAX);
    orl_tex_fill(t->splat_layer, 0);
    orl_cloud_cull(gpu, &proxy->cloud, block);
    struct orl_prog *const passes[] = {proxy->splat_depth, proxy->splat_index};
    for (size_t pass = 0; pass < ORL_COUNT(passes); pass++)
        for (size_t i = 0; i < proxy->cloud.chunk_count; i++) {
            const struct point_chunk *chunk = &proxy->cloud.chunks[i];
            block->size[2] = chunk->count;
            block->size[3] = chunk->first;
            struct orl_dispatch d = {.prog = passes[pass], .params = block,
                                     .images = {{chunk->position_texels, 0, GL_READ_ONLY},
                                                {chunk->item_texels, 0, GL_READ_ONLY},
                                                {chunk->arg_texels, 0, GL_READ_ONLY},
                                                {t->splat_depth, 0, GL_READ_WRITE},
                                                {t->splat_index, 0, GL_READ_WRITE},
                                                {t->splat_layer, 0, GL_READ_WRITE}},
                                     .indirect = chunk->args,
                                     .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT};
            orl_gpu_dispatch(gpu, &d);
        }
}

// Level 0 goes into `depth` without normals, else into the target's splats.
static void resolve(struct orl_gpu *gpu, const struct proxy *proxy, struct splat_block *block,
                    const struct orl_tex *depth, bool normals, struct proxy_target *t)
{
    bool chunks = proxy->cloud.chunk_count > 1;
    struct orl_prog *const *programs = chunks ? proxy->resolve_chunk : proxy->resolve;
    for (size_t i = 0; i < proxy->cloud.chunk_count; i++) {
        const struct point_chunk *chunk = &proxy->cloud.chunks[i];
        block->size[2] = chunk->count;
        block->size[3] = chunk->first;
        struct orl_dispatch d = {.prog = programs[normals], .params = block,
                                 .bufs = {[2] = {.buf = chunk->enlarged}},
                                 .images = {{chunk->position_texels, 0, GL_READ_ONLY},
                                            {chunk->attribute_texels, 0, GL_READ_ONLY},
                                            {t->splat_index, 0, GL_READ_ONLY},
                                            {t->splat_layer, 0, GL_READ_ONLY},
                                            {normals ? t->splats : depth, 0, GL_WRITE_ONLY},
                                            {t->surfel_a[1], 0, GL_WRITE_ONLY},
                                            {t->surfel_b[1], 0, GL_WRITE_ONLY},
                                            {chunk->enlarged_texels, 0, GL_READ_ONLY}},
                                 .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT};
        if (chunks)
            d.images[7] = (struct orl_image_binding){t->chunk_splats, 0, GL_READ_WRITE};
        orl_pixel_groups(t->surfel_a[1]->params.width, t->surfel_a[1]->params.height, d.groups);
        orl_gpu_dispatch(gpu, &d);
    }
}

static void set_level(struct pyramid_block *block, const struct orl_tex *written, int level)
{
    block->level[0] = written->params.width;
    block->level[1] = written->params.height;
    block->level[2] = level;
}

static void pull(struct orl_gpu *gpu, const struct proxy *proxy, struct pyramid_block *block,
                 struct proxy_target *t, int level)
{
    const struct orl_tex *coarse = t->surfel_a[level];
    set_level(block, coarse, level);
    struct orl_dispatch d = {.prog = proxy->pull, .params = block,
                             .images = {{t->surfel_a[level - 1], 0, GL_READ_ONLY},
                                        {t->surfel_b[level - 1], 0, GL_READ_ONLY},
                                        {coarse, 0, GL_WRITE_ONLY},
                                        {t->surfel_b[level], 0, GL_WRITE_ONLY}},
                             .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT};
    orl_pixel_groups(coarse->params.width, coarse->params.height, d.groups);
    orl_gpu_dispatch(gpu, &d);
}

// Into `level` from the one above; level 0 comes out as `depth`, and with the normal if asked for.
static void push(struct orl_gpu *gpu, const struct proxy *proxy, struct pyramid_block *block,
                 struct proxy_target *t, int level, const struct orl_tex *depth, bool normals)
{
    const struct orl_tex *coarse = t->surfel_a[level + 1];
    struct orl_dispatch d = {.prog = level ? proxy->push : proxy->push_last[normals], .params = block,
                             .images = {{coarse, 0, GL_READ_ONLY},
                                        {t->surfel_b[level + 1], 0, GL_READ_ONLY}},
                             .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                        GL_TEXTURE_FETCH_BARRIER_BIT};
    if (level) {
        d.images[2] = (struct orl_image_binding){t->surfel_a[level], 0, GL_READ_WRITE};
        d.images[3] = (struct orl_image_binding){t->surfel_b[level], 0, GL_WRITE_ONLY};
    } else {
        d.images[2] = (struct orl_image_binding){t->splats, 0, GL_READ_ONLY};
        d.images[3] = (struct orl_image_binding){depth, 0, GL_READ_WRITE};
        d.images[4] = (struct orl_image_binding){t->normal, 0, GL_WRITE_ONLY};
    }
    set_level(block, level ? t->surfel_a[level] : t->splats, level);
    // One invocation per corner of the coarse level's pixels.
    orl_pixel_groups(block->level[0] / 2 + 1, block->level[1] / 2 + 1, d.groups);
    orl_gpu_dispatch(gpu, &d);
}

static void drop_strays(struct orl_gpu *gpu, const struct proxy *proxy,
                        struct pyramid_block *block, int least, struct proxy_target *t)
{
    set_level(block, t->depth, 0);
    block->level[3] = least;
    struct orl_dispatch d = {.prog = proxy->support, .params = block,
                             .images = {{t->pushed_depth, 0, GL_READ_ONLY},
                                        {t->depth, 0, GL_WRITE_ONLY},
                                        {t->normal, 0, GL_WRITE_ONLY}},
                             .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                        GL_TEXTURE_FETCH_BARRIER_BIT};
    orl_pixel_groups((t->width + 1) / 2, (t->height + 1) / 2, d.groups);
    orl_gpu_dispatch(gpu, &d);
}

static void pull_push(struct orl_gpu *gpu, const struct proxy *proxy, const struct orl_view *view,
                      int least_support, const struct orl_tex *depth, bool normals,
                      struct proxy_target *t)
{
    struct pyramid_block block = {.camera = {(float)view->camera.fx, (float)view->camera.fy,
                                             (float)view->camera.cx, (float)view->camera.cy}};
    for (int i = 2; i < t->levels; i++)
        pull(gpu, proxy, &block, t, i);
    for (int i = t->levels - 2; i >= 0; i--)
        push(gpu, proxy, &block, t, i, depth, normals);
    if (least_support > 0)
        drop_strays(gpu, proxy, &block, least_support, t);
}

void orl_proxy_draw(struct orl_gpu *gpu, const struct proxy *proxy, const struct orl_view *view,
                    const struct proxy_options *options, bool normals,
                    struct proxy_target *target)
{
    struct splat_block block = splat_params(view, options);
    int least_support = (int)options->min_support;
    const struct orl_tex *depth = least_support > 0 ? target->pushed_depth : target->depth;
    orl_pass_begin(gpu, "splat");
    splat(gpu, proxy, &block, target);
    orl_pass_end(gpu);
    orl_pass_begin(gpu, "pull-push");
    resolve(gpu, proxy, &block, depth, normals, target);
    pull_push(gpu, proxy, view, least_support, depth, normals, target);
    orl_pass_end(gpu);
}

void orl_proxy_color(struct orl_gpu *gpu, const struct proxy *proxy, const struct orl_view *view,
                     const struct proxy_target *t, struct orl_tex *color)
{
    struct splat_block block = splat_params(view, &(struct proxy_options){0});
    for (size_t i = 0; i < proxy->cloud.chunk_count; i++) {
        const struct point_chunk *chunk = &proxy->cloud.chunks[i];
        block.size[2] = chunk->count;
        block.size[3] = chunk->first;
        struct orl_dispatch d = {.prog = proxy->color, .params = &block,
                                 .images = {{chunk->attribute_texels, 0, GL_READ_ONLY},
                                            {t->splat_index, 0, GL_READ_ONLY},
                                            {t->normal, 0, GL_READ_ONLY},
                                            {color, 0, GL_WRITE_ONLY}},
                                 .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT};
        orl_pixel_groups(t->width, t->height, d.groups);
        orl_gpu_dispatch(gpu, &d);
    }
}
