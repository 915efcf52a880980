// The point cloud on the device, in Morton order and in blocks that can be skipped.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/proxy/splats.h"
#include "scene/point_blocks.h"

enum {
    // 128 MiB of positions, half of the 65535 work groups that one dispatch may have. More chunks
    // would cost a resolve pass each.
    CHUNK_POINTS = 16 << 20,
    BLOCK = ORL_BLOCK_POINTS,
};

// points, blocks: of the whole chunk; NULL: zeros.
static enum orl_result make_buffers(struct orl_gpu *gpu, struct point_chunk *chunk, const void *points,
                                    const void *blocks)
{
    size_t count = (size_t)chunk->block_count;
    ORL_TRY(orl_buf_create(gpu, ORL_OWNER_POINTS, "points", count * BLOCK * 8, points, GL_RG32UI, &chunk->points));
    ORL_TRY(orl_buf_create(gpu, ORL_OWNER_POINTS, "point blocks", count * ORL_BLOCK_VEC4S * 16, blocks, GL_RGBA32F,
                           &chunk->blocks));
    ORL_TRY(orl_buf_create(gpu, ORL_OWNER_POINTS, "point list", count * 4, NULL, GL_R32UI, &chunk->list));
    return orl_buf_create(gpu, ORL_OWNER_POINTS, "point list arguments", 16, NULL, GL_R32UI, &chunk->args);
}

static size_t color_bytes(const struct point_chunk *chunk)
{
    return (size_t)chunk->count * 3;
}

// data: sRGB of each point of the chunk.
static enum orl_result make_colors(struct orl_gpu *gpu, struct point_chunk *chunk,
                                   uint8_t (*data)[3])
{
    return orl_buf_create(gpu, ORL_OWNER_POINTS, "point colours", color_bytes(chunk), data, GL_R8UI, &chunk->colors);
}

static enum orl_result upload_chunk(struct orl_gpu *gpu, const struct orl_points *all,
                                    const uint32_t *order, struct point_chunk *chunk)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    uint32_t (*points)[2] = orl_array(log, (size_t)chunk->count, sizeof *points);
    float (*blocks)[ORL_BLOCK_VEC4S][4] = orl_array(log, (size_t)chunk->block_count, sizeof *blocks);
    enum orl_result result = points && blocks ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t b = 0; result == ORL_OK && b < (size_t)chunk->block_count; b++) {
        struct point_block block;
        orl_point_block_make(all, order + b * BLOCK, &block);
        for (size_t i = 0; i < BLOCK; i++)
            memcpy(points[b * BLOCK + i], block.codes[i].geometry, sizeof block.codes[i].geometry);
        memcpy(blocks[b], block.texels, sizeof block.texels);
    }
    ORL_THEN(result, make_buffers(gpu, chunk, points, blocks));
    free(points);
    free(blocks);
    return result;
}

// order: of the chunk's points.
static enum orl_result upload_colors(struct orl_gpu *gpu, const struct orl_points *points,
                                     const uint32_t *order, struct point_chunk *chunk)
{
    size_t count = (size_t)chunk->count;
    uint8_t (*colors)[3] = orl_array(orl_gpu_log(gpu), count, sizeof *colors);
    ORL_TRY_MEMORY(colors);
    for (size_t i = 0; i < count; i++)
        if (order[i] != UINT32_MAX)
            memcpy(colors[i], points->color[order[i]], sizeof *colors);
    enum orl_result result = make_colors(gpu, chunk, colors);
    free(colors);
    return result;
}

size_t orl_cloud_chunk_points(const struct orl_gpu *gpu)
{
    size_t most = (size_t)orl_gpu_caps(gpu)->max_buffer_texels / 3 / BLOCK * BLOCK; // of colours
    return most < CHUNK_POINTS ? most : CHUNK_POINTS;
}

enum orl_result orl_cloud_init(struct orl_gpu *gpu, const struct orl_points *points,
                               struct cloud *cloud)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    *cloud = (struct cloud){.points = points};
    if (points->count > INT32_MAX - BLOCK)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%zu points are too many", points->count);
    size_t most = orl_cloud_chunk_points(gpu);
    uint32_t *order = NULL;
    size_t count = 0;
    enum orl_result result = orl_point_order(log, points, NULL, BLOCK, &order, &count);
    if (result == ORL_OK) {
        cloud->chunks = orl_array(log, count / most + 1, sizeof *cloud->chunks);
        result = cloud->chunks ? ORL_OK : ORL_ERR_MEMORY;
    }
    // An empty cloud is one empty chunk, so that passes that run per chunk still run.
    for (size_t first = 0; result == ORL_OK && (first < count || first == 0); first += most) {
        struct point_chunk *chunk = &cloud->chunks[cloud->chunk_count++];
        size_t here = count - first < most ? count - first : most;
        chunk->block_count = (int)(here / BLOCK);
        chunk->first = (int)first;
        chunk->count = chunk->block_count * BLOCK;
        result = upload_chunk(gpu, points, order + first, chunk);
    }
    free(order);
    if (result != ORL_OK)
        orl_cloud_finish(gpu, cloud);
    return result;
}

enum orl_result orl_cloud_bring_colors(struct orl_gpu *gpu, struct cloud *cloud)
{
    uint32_t *order = NULL;
    size_t count = 0;
    if (cloud->chunks[cloud->chunk_count - 1].colors)
        return ORL_OK;
    enum orl_result result = orl_point_order(orl_gpu_log(gpu), cloud->points, NULL, BLOCK, &order, &count);
    for (size_t i = 0; result == ORL_OK && i < cloud->chunk_count; i++) {
        struct point_chunk *chunk = &cloud->chunks[i];
        if (!chunk->colors) // the memory may have ended before
            result = upload_colors(gpu, cloud->points, order + chunk->first, chunk);
    }
    free(order);
    return result;
}

size_t orl_cloud_bytes(const struct cloud *cloud)
{
    size_t bytes = 0;
    for (size_t i = 0; i < cloud->chunk_count; i++) {
        const struct point_chunk *c = &cloud->chunks[i];
        bytes += c->points->size + c->blocks->size + c->list->size + c->args->size + color_bytes(c);
    }
    return bytes;
}

enum orl_result orl_cloud_empty_chunk(struct orl_gpu *gpu, size_t block_count,
                                      struct cloud *cloud)
{
    struct point_chunk *chunk = cloud->chunks = orl_array(orl_gpu_log(gpu), 1, sizeof *chunk);
    ORL_TRY_MEMORY(chunk);
    cloud->chunk_count = 1;
    chunk->block_count = (int)block_count;
    chunk->count = chunk->block_count * BLOCK;
    ORL_TRY(make_buffers(gpu, chunk, NULL, NULL));
    return make_colors(gpu, chunk, NULL);
}

void orl_cloud_finish(struct orl_gpu *gpu, struct cloud *cloud)
{
    for (size_t i = 0; i < cloud->chunk_count; i++) {
        struct point_chunk *c = &cloud->chunks[i];
        struct orl_buf **const bufs[] = {&c->points, &c->colors, &c->blocks, &c->list, &c->args};
        for (size_t k = 0; k < ORL_COUNT(bufs); k++)
            orl_buf_destroy(gpu, bufs[k]);
    }
    free(cloud->chunks);
    orl_cloud_pages_finish(&cloud->pages);
    memset(cloud, 0, sizeof *cloud);
}

void orl_cloud_cull(struct orl_gpu *gpu, const struct cloud *cloud, struct splat_block *block)
{
    static const uint32_t nothing[4] = {0, 1, 1, 0};
    for (size_t i = 0; i < cloud->chunk_count; i++) {
        const struct point_chunk *chunk = &cloud->chunks[i];
        block->point_count = chunk->count;
        block->first_point = chunk->first;
        orl_buf_write(chunk->args, 0, sizeof nothing, nothing);
        orl_gpu_dispatch(gpu, &(struct orl_dispatch){
            .prog = orl_prog_get(gpu, "proxy/splat_cull.comp", NULL, NULL), ORL_PARAMS(*block),
            .bufs = {chunk->args, chunk->list}, .images = {&chunk->blocks->texels}, .size = {chunk->block_count}});
    }
}
