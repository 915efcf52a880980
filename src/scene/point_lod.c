// Reading points.lod.
#include "scene/point_lod.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/point_code.h"
#include "scene/point_lod_internal.h"

static enum orl_result bad(const struct orl_lod *lod, const char *what)
{
    return orl_fail(lod->log, ORL_ERR_FORMAT, "%s: %s: make it again with oriel lod", lod->path,
                    what);
}

static enum orl_result read_at(const struct orl_lod *lod, uint64_t at, void *data, size_t size)
{
    uint8_t *to = data;
    while (size) {
        ssize_t got = pread(lod->fd, to, size, (off_t)at);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return got ? orl_file_failed(lod->log, lod->path) : bad(lod, "the file is cut off");
        to += got;
        at += (uint64_t)got;
        size -= (size_t)got;
    }
    return ORL_OK;
}

// --- the header and the table ---

// Each level has the pages that its parents need, and the last has one.
static bool levels_fit(const struct lod_header *h)
{
    uint64_t first = 0;
    if (h->level_count < 1 || h->level_count > ORL_LOD_LEVELS_MAX)
        return false;
    for (uint32_t k = 0; k < h->level_count; k++) {
        const struct orl_lod_level *level = &h->levels[k];
        if (level->first != first || !level->count)
            return false;
        first += level->count;
        uint32_t parents = (level->count + ORL_LOD_CHILDREN - 1) / ORL_LOD_CHILDREN;
        if (k + 1 < h->level_count ? h->levels[k + 1].count != parents : level->count != 1)
            return false;
    }
    return first == h->page_count;
}

static enum orl_result read_header(struct orl_lod *lod, struct lod_header *h)
{
    struct stat file;
    ORL_TRY(read_at(lod, 0, h, sizeof *h));
    if (memcmp(h->magic, LOD_MAGIC, sizeof h->magic) != 0)
        return bad(lod, "not a file of levels of detail, or of another version");
    if (h->block_points != ORL_BLOCK_POINTS || h->page_blocks != ORL_LOD_BLOCKS ||
        h->children != ORL_LOD_CHILDREN)
        return bad(lod, "its blocks have another size");
    if (h->page_count > UINT32_MAX || !levels_fit(h) ||
        h->table_at != LOD_PAGES_AT + h->page_count * sizeof(struct orl_lod_data))
        return bad(lod, "its header contradicts itself");
    if (fstat(lod->fd, &file) != 0)
        return orl_file_failed(lod->log, lod->path);
    if ((uint64_t)file.st_size < h->table_at + h->page_count * sizeof(struct orl_lod_page))
        return bad(lod, "the file is cut off");
    lod->points = h->points;
    lod->page_count = (size_t)h->page_count;
    lod->level_count = (int)h->level_count;
    memcpy(lod->levels, h->levels, sizeof lod->levels);
    return ORL_OK;
}

static enum orl_result read_table(struct orl_lod *lod, const struct lod_header *h)
{
    size_t size = lod->page_count * sizeof *lod->pages;
    lod->pages = orl_array(lod->log, lod->page_count, sizeof *lod->pages);
    enum orl_result result = lod->pages ? read_at(lod, h->table_at, lod->pages, size)
                                        : ORL_ERR_MEMORY;
    if (result == ORL_OK && XXH3_64bits(lod->pages, size) != h->table_hash)
        result = bad(lod, "its table of pages is damaged");
    uint64_t points = 0;
    for (size_t i = 0; i < lod->levels[0].count; i++)
        points += lod->pages ? lod->pages[i].count : 0;
    if (result == ORL_OK && points != lod->points)
        result = bad(lod, "its number of points is not that of its pages");
    for (size_t i = 0; result == ORL_OK && i < lod->page_count; i++) {
        const struct orl_lod_page *page = &lod->pages[i];
        bool sound = page->radius >= 0 && isfinite(page->radius);
        for (int k = 0; k < 3; k++)
            sound = sound && isfinite(page->middle[k]) && page->extent[k] >= 0 &&
                    isfinite(page->extent[k]);
        if (!sound)
            result = bad(lod, "a page's bounds are not numbers");
    }
    return result;
}

enum orl_result orl_lod_open(const struct orl_log *log, const char *path, struct orl_lod **out)
{
    struct lod_header header;
    struct orl_lod *lod = *out = orl_array(log, 1, sizeof *lod);
    ORL_TRY_MEMORY(lod);
    *lod = (struct orl_lod){.log = log, .path = orl_strdup(log, path), .fd = -1};
    enum orl_result result = lod->path ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK && (lod->fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK)) < 0)
        result = orl_file_failed(log, path);
    ORL_THEN(result, read_header(lod, &header));
    ORL_THEN(result, read_table(lod, &header));
    if (result != ORL_OK)
        orl_lod_close(out);
    return result;
}

void orl_lod_close(struct orl_lod **handle)
{
    struct orl_lod *lod = *handle;
    if (!lod)
        return;
    if (lod->fd >= 0)
        close(lod->fd);
    free(lod->pages);
    free(lod->path);
    free(lod);
    *handle = NULL;
}

// --- pages ---

// Of what a block states, so that radii and positions that follow from it are finite.
static const float largest = 2e30f;

enum orl_result orl_lod_read(const struct orl_lod *lod, size_t page, struct orl_lod_data *data)
{
    ORL_REQUIRE(lod->log, page < lod->page_count);
    enum orl_result result = read_at(lod, LOD_PAGES_AT + page * sizeof *data, data, sizeof *data);
    if (result == ORL_OK && XXH3_64bits(data, sizeof *data) != lod->pages[page].hash)
        result = bad(lod, "a page is damaged");
    for (size_t b = 0; result == ORL_OK && b < ORL_LOD_BLOCKS; b++) {
        const float *texels = &data->blocks[b][0][0];
        float count = data->blocks[b][1][3];
        bool sound = count >= 0 && count <= ORL_BLOCK_POINTS && count == floorf(count);
        for (int i = 0; i < 4 * ORL_BLOCK_VEC4S; i++)
            sound = sound && fabsf(texels[i]) <= largest;
        if (!sound)
            result = bad(lod, "a block is damaged");
    }
    return result;
}

enum orl_result orl_lod_check(const struct orl_log *log, const char *path)
{
    struct orl_lod *lod = NULL;
    enum orl_result result = orl_lod_open(log, path, &lod);
    struct orl_lod_data *data = result == ORL_OK ? orl_array(log, 1, sizeof *data) : NULL;
    if (result == ORL_OK && !data)
        result = ORL_ERR_MEMORY;
    for (size_t page = 0; result == ORL_OK && page < lod->page_count; page++)
        result = orl_lod_read(lod, page, data);
    free(data);
    orl_lod_close(&lod);
    return result;
}

int orl_lod_children(const struct orl_lod *lod, size_t page, size_t *first, size_t *count)
{
    int k = 0;
    while (page >= (size_t)lod->levels[k].first + lod->levels[k].count)
        k++;
    *first = *count = 0;
    if (k > 0) {
        const struct orl_lod_level *below = &lod->levels[k - 1];
        size_t at = (page - lod->levels[k].first) * ORL_LOD_CHILDREN;
        *count = below->count - at < ORL_LOD_CHILDREN ? below->count - at : ORL_LOD_CHILDREN;
        *first = below->first + at;
    }
    return k;
}

// --- a sample ---

bool orl_lod_decode(const struct orl_lod_data *page, size_t b, size_t i, struct orl_points *points)
{
    const struct point_frame frame = orl_point_block_frame(page->blocks[b]);
    const uint32_t *geometry = page->geometry[b][i];
    const size_t to = points->count;
    orl_point_decode_normal(geometry, points->normal[to]);
    points->radius[to] = orl_point_decode_radius(&frame, geometry);
    memcpy(points->color[to], page->colors[b][i], sizeof points->color[to]);
    return orl_point_decode_position(&frame, geometry, points->position[to]);
}

static void take_block(const struct orl_lod_data *data, size_t b, struct orl_points *points)
{
    for (size_t i = 0; i < (size_t)data->blocks[b][1][3]; i++)
        points->count += orl_lod_decode(data, b, i, points) &&
                         orl_point_usable(points->position[points->count]);
}

enum orl_result orl_lod_sample(const struct orl_lod *lod, size_t most, struct orl_points *points)
{
    enum { PAGE_POINTS = ORL_LOD_BLOCKS * ORL_BLOCK_POINTS };
    int k = 0;
    memset(points, 0, sizeof *points);
    while (k + 1 < lod->level_count && (uint64_t)lod->levels[k].count * PAGE_POINTS > most)
        k++;
    const struct orl_lod_level *level = &lod->levels[k];
    struct orl_lod_data *data = orl_array(lod->log, 1, sizeof *data);
    enum orl_result result =
        data ? orl_points_init(lod->log, points, (size_t)level->count * PAGE_POINTS)
             : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        points->count = 0;
    for (size_t page = 0; result == ORL_OK && page < level->count; page++) {
        result = orl_lod_read(lod, level->first + page, data);
        for (size_t b = 0; result == ORL_OK && b < ORL_LOD_BLOCKS; b++)
            take_block(data, b, points);
    }
    free(data);
    if (result != ORL_OK)
        orl_points_finish(points);
    return result;
}

enum orl_result orl_lod_read_cloud(const struct orl_log *log, const char *dir, size_t most,
                                   struct orl_points *points)
{
    struct orl_lod *lod = NULL;
    const char *paged = ORL_PATH(dir, ORL_LOD_NAME);
    memset(points, 0, sizeof *points);
    if (!orl_path_is_file(paged))
        return orl_points_read(log, ORL_PATH(dir, "points.ply"), NULL, points);
    enum orl_result result = orl_lod_open(log, paged, &lod);
    ORL_THEN(result, orl_lod_sample(lod, most, points));
    orl_lod_close(&lod);
    return result;
}
