// The pages and levels of points.lod, from blocks in their order.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/point_lod_internal.h"

// The part of a block that its parent takes, in points.
enum { TAKEN = ORL_BLOCK_POINTS / ORL_LOD_CHILDREN };

struct level {
    struct orl_atomic_file temp; // of levels above 0; never takes its final name
    FILE *file;
    struct orl_lod_data page;    // being filled
    int filled;                  // its blocks
    struct point_block group[ORL_LOD_CHILDREN]; // blocks whose parent is not made yet
    int grouped;
    struct orl_lod_page *pages;
    size_t page_count, page_capacity;
    uint64_t points;
};

struct lod_levels {
    const struct orl_log *log;
    char *path; // owned
    int count;  // of levels that have begun
    struct level *level[ORL_LOD_LEVELS_MAX];
    struct orl_points taken; // of the parent that is being made
    uint32_t order[ORL_BLOCK_POINTS];
};

static enum orl_result add_level(struct lod_levels *l, FILE *file)
{
    ORL_REQUIRE(l->log, l->count < ORL_LOD_LEVELS_MAX);
    struct level *level = orl_array(l->log, 1, sizeof *level);
    ORL_TRY_MEMORY(level);
    l->level[l->count++] = level;
    level->file = file;
    if (file)
        return ORL_OK;
    ORL_TRY(orl_atomic_open(l->log, l->path, &level->temp));
    level->file = level->temp.stream;
    return ORL_OK;
}

enum orl_result orl_lod_levels_begin(const struct orl_log *log, const char *path, FILE *file,
                                     struct lod_levels **out)
{
    struct lod_levels *l = *out = orl_array(log, 1, sizeof *l);
    ORL_TRY_MEMORY(l);
    l->log = log;
    l->path = orl_strdup(log, path);
    enum orl_result result = l->path ? orl_points_init(log, &l->taken, ORL_BLOCK_POINTS)
                                     : ORL_ERR_MEMORY;
    ORL_THEN(result, add_level(l, file));
    if (result != ORL_OK)
        orl_lod_levels_destroy(out);
    return result;
}

void orl_lod_levels_destroy(struct lod_levels **levels)
{
    struct lod_levels *l = *levels;
    if (!l)
        return;
    for (int k = 0; k < l->count; k++) {
        orl_atomic_abort(&l->level[k]->temp);
        free(l->level[k]->pages);
        free(l->level[k]);
    }
    orl_points_finish(&l->taken);
    free(l->path);
    free(l);
    *levels = NULL;
}

// --- pages ---

// Bounds, number and mean size of a page's points.
static struct orl_lod_page describe_page(const struct orl_lod_data *page)
{
    struct orl_lod_page entry = {0};
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    double squares = 0; // of radii
    for (size_t b = 0; b < ORL_LOD_BLOCKS; b++) {
        const float(*block)[4] = page->blocks[b];
        float count = block[1][3];
        const struct point_frame frame = orl_point_block_frame(block);
        if (!(count > 0))
            continue;
        entry.count += (uint32_t)count;
        for (int k = 0; k < 3; k++) {
            low[k] = fminf(low[k], block[0][k] - block[1][k]);
            high[k] = fmaxf(high[k], block[0][k] + block[1][k]);
        }
        for (size_t i = 0; i < (size_t)count; i++)
            squares += pow((double)orl_point_decode_radius(&frame, page->geometry[b][i]), 2);
    }
    for (int k = 0; entry.count && k < 3; k++) {
        entry.middle[k] = 0.5f * low[k] + 0.5f * high[k];
        // Measured from the rounded middle, so that no block lies outside.
        entry.extent[k] = fmaxf(high[k] - entry.middle[k], entry.middle[k] - low[k]);
    }
    entry.radius = entry.count ? (float)sqrt(squares / entry.count) : 0;
    return entry;
}

static enum orl_result flush_page(struct lod_levels *l, struct level *level)
{
    if (!level->filled)
        return ORL_OK;
    ORL_TRY(ORL_GROW(l->log, level->pages, level->page_capacity, level->page_count));
    struct orl_lod_page entry = describe_page(&level->page);
    entry.hash = XXH3_64bits(&level->page, sizeof level->page);
    level->points += entry.count;
    level->pages[level->page_count++] = entry;
    if (fwrite(&level->page, sizeof level->page, 1, level->file) != 1)
        return orl_file_failed(l->log, l->path);
    memset(&level->page, 0, sizeof level->page);
    level->filled = 0;
    return ORL_OK;
}

static void put_block(const struct point_block *block, struct level *level)
{
    struct orl_lod_data *page = &level->page;
    int b = level->filled++;
    memcpy(page->blocks[b], block->texels, sizeof block->texels);
    for (size_t i = 0; i < ORL_BLOCK_POINTS; i++) {
        memcpy(page->geometry[b][i], block->codes[i].geometry, sizeof block->codes[i].geometry);
        memcpy(page->colors[b][i], block->codes[i].color, sizeof block->codes[i].color);
    }
}

// --- parents ---

// Takes point i of a child, if it has as many, enlarged to cover the area of those left out.
static void take_point(const struct point_block *child, int i, struct orl_points *taken)
{
    float count = child->texels[1][3], drawn = fminf(count, TAKEN);
    const struct point_frame frame = orl_point_block_frame(child->texels);
    const struct point_code *code = &child->codes[i];
    size_t to = taken->count;
    if ((float)i >= count ||
        !orl_point_decode_position(&frame, code->geometry, taken->position[to]))
        return;
    orl_point_decode_normal(code->geometry, taken->normal[to]);
    taken->radius[to] = orl_point_decode_radius(&frame, code->geometry) * sqrtf(count / drawn);
    memcpy(taken->color[to], code->color, sizeof code->color);
    taken->count++;
}

// Takes one point of each child in turn, the children in bit-reversed order, so that any first part
// of the parent is spread evenly, too.
static void make_parent(struct lod_levels *l, const struct level *level, struct point_block *parent)
{
    static const int turns[ORL_LOD_CHILDREN] = {0, 4, 2, 6, 1, 5, 3, 7};
    l->taken.count = 0;
    for (int i = 0; i < TAKEN; i++)
        for (int turn = 0; turn < ORL_LOD_CHILDREN; turn++)
            if (turns[turn] < level->grouped)
                take_point(&level->group[turns[turn]], i, &l->taken);
    for (size_t i = 0; i < ORL_BLOCK_POINTS; i++)
        l->order[i] = i < l->taken.count ? (uint32_t)i : UINT32_MAX;
    orl_point_block_make(&l->taken, l->order, parent);
}

static enum orl_result add(struct lod_levels *l, int k, const struct point_block *block);

static enum orl_result close_group(struct lod_levels *l, int k)
{
    struct level *level = l->level[k];
    struct point_block parent;
    if (!level->grouped)
        return ORL_OK;
    make_parent(l, level, &parent);
    level->grouped = 0;
    ORL_TRY(k + 1 < l->count ? ORL_OK : add_level(l, NULL));
    return add(l, k + 1, &parent);
}

static enum orl_result add(struct lod_levels *l, int k, const struct point_block *block)
{
    struct level *level = l->level[k];
    enum orl_result result = ORL_OK;
    put_block(block, level);
    if (level->filled == ORL_LOD_BLOCKS)
        result = flush_page(l, level);
    level->group[level->grouped++] = *block;
    if (result == ORL_OK && level->grouped == ORL_LOD_CHILDREN)
        result = close_group(l, k);
    return result;
}

enum orl_result orl_lod_levels_add(struct lod_levels *levels, const struct point_block *block)
{
    return add(levels, 0, block);
}

// --- the end ---

static enum orl_result append(struct lod_levels *l, struct level *level)
{
    enum orl_result result = fseeko(level->file, 0, SEEK_SET) == 0 ? ORL_OK : orl_file_failed(l->log, l->path);
    for (size_t i = 0; result == ORL_OK && i < level->page_count; i++)
        if (fread(&level->page, sizeof level->page, 1, level->file) != 1 ||
            fwrite(&level->page, sizeof level->page, 1, l->level[0]->file) != 1)
            result = orl_file_failed(l->log, l->path);
    return result;
}

// The table goes behind the pages, and the header before them.
static enum orl_result write_table(struct lod_levels *l, struct lod_header *h)
{
    FILE *file = l->level[0]->file;
    struct orl_lod_page *table = orl_array(l->log, h->page_count, sizeof *table);
    ORL_TRY_MEMORY(table);
    for (uint32_t k = 0; k < h->level_count; k++)
        memcpy(table + h->levels[k].first, l->level[k]->pages,
               h->levels[k].count * sizeof *table);
    h->table_at = LOD_PAGES_AT + h->page_count * sizeof(struct orl_lod_data);
    h->table_hash = XXH3_64bits(table, h->page_count * sizeof *table);
    bool written = fwrite(table, sizeof *table, h->page_count, file) == h->page_count &&
                   fseeko(file, 0, SEEK_SET) == 0 && fwrite(h, sizeof *h, 1, file) == 1;
    free(table);
    return written ? ORL_OK : orl_file_failed(l->log, l->path);
}

enum orl_result orl_lod_levels_end(struct lod_levels *l)
{
    struct lod_header header = {.block_points = ORL_BLOCK_POINTS, .page_blocks = ORL_LOD_BLOCKS,
                                .children = ORL_LOD_CHILDREN};
    memcpy(header.magic, LOD_MAGIC, sizeof header.magic); // without its end
    enum orl_result result = ORL_OK;
    bool top = false;
    for (int k = 0; result == ORL_OK && !top; k++) {
        struct level *level = l->level[k];
        result = flush_page(l, level);
        top = level->page_count <= 1;
        if (result == ORL_OK && !top)
            result = close_group(l, k);
        if (result == ORL_OK && k > 0)
            result = append(l, level);
        if (level->page_count > UINT32_MAX - header.page_count)
            result = orl_fail(l->log, ORL_ERR_UNSUPPORTED, "%s: too many points", l->path);
        header.levels[k] = (struct orl_lod_level){(uint32_t)header.page_count,
                                                  (uint32_t)level->page_count};
        header.page_count += level->page_count;
        header.level_count++;
    }
    header.points = l->level[0]->points;
    if (result == ORL_OK && !header.points)
        result = orl_fail(l->log, ORL_ERR_DATA, "%s: no usable points", l->path);
    return result == ORL_OK ? write_table(l, &header) : result;
}
