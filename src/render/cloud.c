// The point cloud on the device, in Morton order and in blocks that can be skipped or thinned.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/cloud.h"
#include "render/point_code.h"

enum {
    // 128 MiB of positions, half of the 65535 work groups that one dispatch may have. More chunks
    // would cost a resolve pass each.
    CHUNK_POINTS = 16 << 20,
    BLOCK = ORL_BLOCK_POINTS,
    SORT_BITS = 11, // bits per radix pass
    SORT_RANGE = 1 << SORT_BITS,
    BOUNDS_SAMPLES = 4096,
    PARTS = BLOCK / ORL_ITEM_POINTS,
        SPLITS = 16, // one in so many blocks may be split for precision
    DENSITY_SAMPLES = 16, // points of a block whose neighbours are measured
    NEIGHBOUR = 4,
};

struct key {
    uint64_t code;
    uint32_t point;
};

// --- order ---

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

// A cube around nearly all points, with a margin, so that a distant outlier does not merge all
// other points into one cell. Points outside belong to the outermost cells. With a cube the cells
// are cubes too, and blocks are equally wide in all directions.
struct cube {
    double low[3], side;
};

static enum orl_result find_cube(const struct orl_log *log, const struct orl_points *points,
                                 struct cube *cube)
{
    size_t count = points->count < BOUNDS_SAMPLES ? points->count : BOUNDS_SAMPLES;
    float *values = orl_array(log, count + 1, sizeof *values);
    if (!values)
        return ORL_ERR_MEMORY;
    cube->side = 1e-30;
    for (int k = 0; k < 3; k++) {
        size_t finite = 0;
        for (size_t i = 0; i < count; i++) {
            float v = points->position[i * (points->count / count)][k];
            if (isfinite(v))
                values[finite++] = v;
        }
        if (finite == 0)
            values[finite++] = 0;
        qsort(values, finite, sizeof *values, compare_floats);
        double a = values[finite / 64], b = values[finite - 1 - finite / 64];
        cube->low[k] = 0.5 * (a + b);
        cube->side = fmax(cube->side, 2 * (b - a) + 1e-6 * fabs(a + b));
    }
    // The cube is off-centre: its middle plane would split a flat cloud into two layers, each of
    // half the density.
    for (int k = 0; k < 3; k++)
        cube->low[k] -= 0.437 * cube->side;
    free(values);
    return ORL_OK;
}

// Spreads the low 21 bits of x to every third bit of the result.
static uint64_t spread_bits(uint64_t x)
{
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

static uint64_t morton_code(const float p[3], const struct cube *cube)
{
    uint64_t code = 0;
    for (int k = 0; k < 3; k++) {
        double cell = ((double)p[k] - cube->low[k]) / cube->side * 0x1p21;
        cell = fmin(fmax(cell, 0), 0x1p21 - 1);
        code |= spread_bits((uint64_t)cell) << k;
    }
    return code;
}

// Radix sort from the least significant digit: stable, thus the same order on every machine.
static void sort_keys(struct key **keys, struct key **spare, size_t count)
{
    for (int shift = 0; shift < 63; shift += SORT_BITS) {
        size_t starts[SORT_RANGE] = {0}, sum = 0;
        for (size_t i = 0; i < count; i++)
            starts[(*keys)[i].code >> shift & (SORT_RANGE - 1)]++;
        for (size_t d = 0; d < SORT_RANGE; d++) {
            size_t here = starts[d];
            starts[d] = sum;
            sum += here;
        }
        for (size_t i = 0; i < count; i++)
            (*spare)[starts[(*keys)[i].code >> shift & (SORT_RANGE - 1)]++] = (*keys)[i];
        struct key *swap = *keys;
        *keys = *spare;
        *spare = swap;
    }
}

// Puts the points of a block into bit-reversed order, so that any first part is spread evenly.
static void shuffle_block(struct key *keys, size_t count)
{
    struct key sorted[BLOCK];
    size_t next = 0;
    memcpy(sorted, keys, count * sizeof *keys);
    for (unsigned i = 0; i < BLOCK; i++) {
        unsigned from = 0;
        for (unsigned bit = 1; bit < BLOCK; bit *= 2)
            from = 2 * from + (i & bit ? 1 : 0);
        if (from < count)
            keys[next++] = sorted[from];
    }
}

// How many of the points at `keys` make the next block: as many as fit, unless storage in one block
// would be imprecise because distances or radii within it are very different.
static size_t block_size(const struct orl_points *points, const struct key *keys, size_t count)
{
    struct point_range range = orl_point_range_none();
    size_t most = count < BLOCK ? count : BLOCK;
    for (size_t i = 0; i < most; i++) {
        uint32_t point = keys[i].point;
        orl_point_range_add(&range, points->position[point], points->radius[point]);
        if (i > 0 && !orl_point_range_is_precise(&range))
            return i;
    }
    return most;
}

// Divides sorted points into blocks, each filled up to BLOCK entries without a point.
static size_t make_blocks(const struct orl_points *points, const struct key *sorted, size_t count,
                          struct key *order, size_t capacity)
{
    size_t to = 0, first = 0;
    while (first < count) {
        size_t left = count - first, needed = (left + BLOCK - 1) / BLOCK * BLOCK;
        size_t here = left < BLOCK ? left : BLOCK;
        if (to + needed + BLOCK <= capacity) // there is room for one more block
            here = block_size(points, sorted + first, left);
        memcpy(order + to, sorted + first, here * sizeof *order);
        shuffle_block(order + to, here);
        for (size_t i = here; i < BLOCK; i++)
            order[to + i] = (struct key){0, UINT32_MAX};
        to += BLOCK;
        first += here;
    }
    return to;
}

// Finds the order in which the points are drawn, without points that are not finite: whole blocks,
// whose entries without a point have UINT32_MAX. *order is owned by the caller (free).
static enum orl_result find_order(const struct orl_log *log, const struct orl_points *points,
                                  struct key **order, size_t *count)
{
    struct cube cube;
    size_t blocks = points->count / BLOCK + 1, used = 0;
    size_t capacity = (blocks + blocks / SPLITS + SPLITS) * BLOCK;
    struct key *keys = orl_array(log, points->count, sizeof *keys);
    struct key *spare = orl_array(log, points->count, sizeof *spare);
    *order = orl_array(log, capacity, sizeof **order);
    *count = 0;
    enum orl_result result = keys && spare && *order ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = find_cube(log, points, &cube);
    if (result == ORL_OK) {
        for (size_t i = 0; i < points->count; i++) {
            const float *p = points->position[i];
            if (isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]))
                keys[used++] = (struct key){morton_code(p, &cube), (uint32_t)i};
        }
        sort_keys(&keys, &spare, used);
        *count = make_blocks(points, keys, used, *order, capacity);
    } else {
        free(*order);
        *order = NULL;
    }
    free(keys);
    free(spare);
    return result;
}

// --- blocks ---

// Points per unit of area, from the distances of a few points to their fourth neighbour in the
// block: a disc of that radius holds four points. Distances are measured within the tangent plane
// of the point, since depth noise does not make a surface larger. 0: unknown.
static float density(float (*const p)[3], const struct orl_points *points,
                     const struct key *order, size_t count)
{
    float distances[DENSITY_SAMPLES];
    size_t samples = count < DENSITY_SAMPLES ? count : DENSITY_SAMPLES;
    if (count <= NEIGHBOUR)
        return 0;
    for (size_t s = 0; s < samples; s++) {
        float nearest[NEIGHBOUR] = {INFINITY, INFINITY, INFINITY, INFINITY};
        const float *n = points->normal[order[s].point];
        for (size_t i = 0; i < count; i++) {
            float x = p[i][0] - p[s][0], y = p[i][1] - p[s][1], z = p[i][2] - p[s][2];
            float along = x * n[0] + y * n[1] + z * n[2];
            float d2 = x * x + y * y + z * z - along * along;
            if (i == s || !(d2 < nearest[NEIGHBOUR - 1]))
                continue;
            int at = NEIGHBOUR - 1;
            for (; at > 0 && d2 < nearest[at - 1]; at--)
                nearest[at] = nearest[at - 1];
            nearest[at] = d2;
        }
        distances[s] = nearest[NEIGHBOUR - 1];
    }
    qsort(distances, samples, sizeof *distances, compare_floats);
    float d2 = distances[samples / 2];
    return d2 > 0 ? NEIGHBOUR / (3.14159265f * d2) : 0;
}

// Writes the texels of a block, which shaders/proxy/splat_cull.comp explains.
static void describe_block(float (*const positions)[3], const struct orl_points *points,
                           const struct key *order, size_t count, const struct point_frame *frame,
                           float block[ORL_BLOCK_VEC4S][4])
{
    for (int k = 0; k < 3; k++) {
        float low = positions[0][k], high = low;
        double normal = 0;
        for (size_t i = 0; i < count; i++) {
            low = fminf(low, positions[i][k]);
            high = fmaxf(high, positions[i][k]);
            normal += points->normal[order[i].point][k];
        }
        block[0][k] = 0.5f * low + 0.5f * high;
        // Measured from the rounded middle, so that no point lies outside.
        block[1][k] = fmaxf(high - block[0][k], block[0][k] - low);
        block[2][k] = (float)(normal / (double)count);
        block[3][k] = frame->origin[k];
    }
    block[0][3] = density(positions, points, order, count);
    block[1][3] = (float)count;
    block[3][3] = frame->step;
}

// --- upload ---

// A chunk in host memory. Points are stored part by part: the first parts of all blocks, then the
// second parts, and so on. When blocks are thinned, the points that are read are contiguous.
struct host_chunk {
    uint32_t (*positions)[2];
    uint32_t *attributes;
    float (*blocks)[ORL_BLOCK_VEC4S][4];
    size_t block_count;
};

static enum orl_result make_buffers(struct orl_gpu *gpu, struct point_chunk *chunk,
                                    const struct host_chunk *host)
{
    size_t blocks = host->block_count, points = blocks * BLOCK;
    const struct {
        const char *tag;
        size_t size;
        const void *data;
        struct orl_buf **buf;
        GLenum format;
        struct orl_tex **texels;
    } rows[] = {
        {"point positions", points * 8, host->positions, &chunk->positions, GL_RG32UI,
         &chunk->position_texels},
        {"point attributes", points * 4, host->attributes, &chunk->attributes, GL_R32UI,
         &chunk->attribute_texels},
        {"point blocks", blocks * sizeof *host->blocks, host->blocks, &chunk->blocks, GL_RGBA32F,
         &chunk->block_texels},
        {"point block enlargement", blocks * 4, NULL, &chunk->enlarged, GL_R32F,
         &chunk->enlarged_texels},
        {"point list", blocks * PARTS * 4, NULL, &chunk->items, GL_R32UI, &chunk->item_texels},
        {"point list arguments", 16, NULL, &chunk->args, GL_R32UI, &chunk->arg_texels},
    };
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(rows); i++) {
        result = orl_buf_create(gpu, ORL_OWNER_POINTS, rows[i].tag, rows[i].size, rows[i].data,
                                rows[i].buf);
        if (result == ORL_OK)
            result = orl_tex_view_buffer(gpu, *rows[i].buf, rows[i].format, rows[i].texels);
    }
    return result;
}

// Where point i of a block is stored in its chunk.
static size_t place_in_chunk(size_t i, size_t block, size_t block_count)
{
    return (i / ORL_ITEM_POINTS * block_count + block) * ORL_ITEM_POINTS + i % ORL_ITEM_POINTS;
}

// order: BLOCK entries; those without a point come last.
static void fill_block(const struct orl_points *points, const struct key *order, size_t block,
                       struct host_chunk *host)
{
    float positions[BLOCK][3];
    struct point_range range = orl_point_range_none();
    size_t count = 0;
    for (; count < BLOCK && order[count].point != UINT32_MAX; count++) {
        size_t from = order[count].point;
        orl_point_range_add(&range, points->position[from], points->radius[from]);
    }
    const struct point_frame frame = orl_point_frame(&range);
    for (size_t i = 0; i < BLOCK; i++) {
        size_t to = place_in_chunk(i, block, host->block_count), from = order[i].point;
        struct point_code code = orl_point_code_none;
        if (i < count) {
            code = orl_point_encode(&frame, points->position[from], points->normal[from],
                                    points->color[from], points->radius[from]);
            orl_point_decode_position(&frame, code.position, positions[i]);
        }
        memcpy(host->positions[to], code.position, sizeof code.position);
        host->attributes[to] = code.attributes;
    }
    describe_block(positions, points, order, count, &frame, host->blocks[block]);
}

static enum orl_result upload_chunk(struct orl_gpu *gpu, const struct orl_points *points,
                                    const struct key *order, struct point_chunk *chunk)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct host_chunk host = {.block_count = (size_t)chunk->block_count};
    host.positions = orl_array(log, host.block_count * BLOCK, sizeof *host.positions);
    host.attributes = orl_array(log, host.block_count * BLOCK, sizeof *host.attributes);
    host.blocks = orl_array(log, host.block_count, sizeof *host.blocks);
    enum orl_result result =
        host.positions && host.attributes && host.blocks ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t b = 0; result == ORL_OK && b < host.block_count; b++)
        fill_block(points, order + b * BLOCK, b, &host);
    if (result == ORL_OK)
        result = make_buffers(gpu, chunk, &host);
    free(host.positions);
    free(host.attributes);
    free(host.blocks);
    return result;
}

// Points of a chunk: whole blocks, as many as the device can read of a buffer.
static size_t chunk_points(const struct orl_gpu *gpu)
{
    size_t most = (size_t)orl_gpu_caps(gpu)->max_buffer_texels / BLOCK * BLOCK;
    return most < CHUNK_POINTS ? most : CHUNK_POINTS;
}

enum orl_result orl_cloud_map(const struct orl_gpu *gpu, const struct orl_points *points,
                              uint32_t **map, size_t *count)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    size_t most = chunk_points(gpu);
    struct key *order = NULL;
    *map = NULL;
    enum orl_result result = find_order(log, points, &order, count);
    if (result == ORL_OK)
        *map = orl_array(log, *count, sizeof **map);
    if (!*map || !order) {
        free(order);
        return result == ORL_OK ? ORL_ERR_MEMORY : result;
    }
    for (size_t i = 0; i < *count; i++) {
        size_t first = i / most * most, here = *count - first < most ? *count - first : most;
        size_t block = (i - first) / BLOCK, blocks = here / BLOCK;
        (*map)[first + place_in_chunk(i % BLOCK, block, blocks)] = order[i].point;
    }
    free(order);
    return ORL_OK;
}

enum orl_result orl_cloud_init(struct orl_gpu *gpu, const struct orl_points *points,
                               struct cloud *cloud)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    memset(cloud, 0, sizeof *cloud);
    if (points->count > INT32_MAX - BLOCK)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%zu points are too many", points->count);
    size_t most = chunk_points(gpu);
    struct key *order = NULL;
    size_t count = 0;
    enum orl_result result = find_order(log, points, &order, &count);
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

void orl_cloud_finish(struct orl_gpu *gpu, struct cloud *cloud)
{
    for (size_t i = 0; i < cloud->chunk_count; i++) {
        struct point_chunk *c = &cloud->chunks[i];
        struct orl_tex **const views[] = {&c->position_texels, &c->attribute_texels,
                                          &c->block_texels, &c->enlarged_texels, &c->item_texels,
                                          &c->arg_texels};
        struct orl_buf **const bufs[] = {&c->positions, &c->attributes, &c->blocks, &c->enlarged,
                                         &c->items, &c->args};
        for (size_t k = 0; k < ORL_COUNT(views); k++)
            orl_tex_destroy(gpu, views[k]);
        for (size_t k = 0; k < ORL_COUNT(bufs); k++)
            orl_buf_destroy(gpu, bufs[k]);
    }
    free(cloud->chunks);
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
        struct orl_dispatch d = {.prog = orl_prog_get(gpu, "proxy/splat_cull.comp", NULL, NULL),
                                 .params = block, .params_size = sizeof *block,
                                 .bufs = {{.buf = chunk->args}, {.buf = chunk->items},
                                          {.buf = chunk->enlarged}},
                                 .images = {{chunk->block_texels, 0, GL_READ_ONLY}},
                                 .groups = {orl_groups((size_t)chunk->block_count,
                                                       ORL_POINT_GROUP)},
                                 .barrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                            GL_SHADER_STORAGE_BARRIER_BIT |
                                            GL_COMMAND_BARRIER_BIT};
        orl_gpu_dispatch(gpu, &d);
    }
}
