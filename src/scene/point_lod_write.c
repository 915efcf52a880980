// Writing points.lod: parts of the Morton curve, one after the other, are given radii, limited and
// sorted into blocks, which fill the pages of level 0. Each coarser level is made of the one below.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>
#include <xxhash.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/point_lod_internal.h"
#include "scene/point_parts.h"
#include "scene/point_stream.h"

// The part of a block that its parent takes, in points.
enum { TAKEN = ORL_BLOCK_POINTS / ORL_LOD_CHILDREN };

struct writer {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct orl_lod_params *params;
    const char *path;
    struct point_parts parts;
    struct orl_disc_sizes sizes;
    struct orl_radii_limits limits;
    struct orl_atomic_file out;    // stands behind the last page
    struct orl_lod_data *page, *below; // owned; the page being filled, one whose parents are made
    int filled;                    // blocks of the page
    struct orl_lod_page *pages;    // owned; of all levels
    size_t page_count, page_capacity;
    struct orl_points taken;       // of the parent that is being made
};

static enum orl_result for_parts(struct writer *w, const char *step,
                                 enum orl_result (*use)(struct writer *w, size_t part))
{
    enum orl_result result = ORL_OK;
    uint64_t done = 0;
    for (size_t i = 0; result == ORL_OK && i < w->parts.count; i++) {
        orl_progress_report(w->progress, step, (double)done, (double)w->parts.total, NULL);
        result = orl_progress_cancelled(w->progress) ? ORL_ERR_CANCELLED : use(w, i);
        done += orl_point_parts_own(&w->parts, i);
    }
    orl_progress_report(w->progress, step, (double)w->parts.total, (double)w->parts.total, NULL);
    return result;
}

// --- radii ---

static enum orl_result set_radii(struct writer *w, size_t part)
{
    const struct orl_lod_params *params = w->params;
    struct orl_points points = {0};
    float *scales = NULL;
    enum orl_result result = orl_point_parts_read(&w->parts, part, true, &points, &scales);
    size_t own = orl_point_parts_own(&w->parts, part);
    ORL_THEN(result, orl_points_set_some_radii(w->log, NULL, &params->radii, params->views,
                                               params->view_count, own, &points));
    if (result == ORL_OK) {
        points.count = own;
        orl_disc_sizes_add(&w->sizes, params->views, params->view_count, &points, scales);
        result = orl_point_parts_write(&w->parts, part, &points, scales);
    }
    orl_points_finish(&points);
    free(scales);
    return result;
}

static enum orl_result find_radii(struct writer *w)
{
    const struct orl_lod_params *params = w->params;
    const struct orl_radii_limits limits = orl_radii_limits_of(&params->radii);
    if (!w->parts.flat)
        return ORL_OK;
    ORL_TRY(orl_disc_sizes_init(w->log, &w->sizes));
    ORL_TRY(for_parts(w, "radii", set_radii));
    w->limits = orl_radii_limits_widened(&limits, &w->sizes);
    return ORL_OK;
}

// --- pages ---

// Bounds, number and mean size of a page's points.
static struct orl_lod_page describe_page(const struct orl_lod_data *page)
{
    struct orl_lod_page entry = {0};
    struct point_range range = orl_point_range_none();
    double squares = 0; // of radii
    for (size_t b = 0; b < ORL_LOD_BLOCKS; b++) {
        const float(*block)[4] = page->blocks[b];
        float count = block[1][3];
        const struct point_frame frame = orl_point_block_frame(block);
        if (!(count > 0))
            continue;
        entry.count += (uint32_t)count;
        for (int side = -1; side <= 1; side += 2) {
            float corner[3];
            for (int k = 0; k < 3; k++)
                corner[k] = block[0][k] + (float)side * block[1][k];
            orl_point_range_add(&range, corner, 0);
        }
        for (size_t i = 0; i < (size_t)count; i++)
            squares += pow((double)orl_point_decode_radius(&frame, page->geometry[b][i]), 2);
    }
    if (entry.count)
        orl_point_range_box(&range, entry.middle, entry.extent);
    entry.radius = entry.count ? (float)sqrt(squares / entry.count) : 0;
    return entry;
}

static enum orl_result flush_page(struct writer *w)
{
    if (!w->filled)
        return ORL_OK;
    if (w->page_count == UINT32_MAX)
        return orl_fail(w->log, ORL_ERR_UNSUPPORTED, "%s: too many points", w->path);
    ORL_TRY(ORL_GROW(w->log, w->pages, w->page_capacity, w->page_count));
    struct orl_lod_page entry = describe_page(w->page);
    entry.hash = XXH3_64bits(w->page, sizeof *w->page);
    w->pages[w->page_count++] = entry;
    if (fwrite(w->page, sizeof *w->page, 1, w->out.stream) != 1)
        return orl_file_failed(w->log, w->path);
    memset(w->page, 0, sizeof *w->page);
    w->filled = 0;
    return ORL_OK;
}

static enum orl_result add_block(struct writer *w, const struct orl_points *points, const uint32_t *order)
{
    struct point_block block;
    int b = w->filled++;
    orl_point_block_make(points, order, &block);
    memcpy(w->page->blocks[b], block.texels, sizeof block.texels);
    for (size_t i = 0; i < ORL_BLOCK_POINTS; i++) {
        memcpy(w->page->geometry[b][i], block.codes[i].geometry, sizeof block.codes[i].geometry);
        memcpy(w->page->colors[b][i], block.codes[i].color, sizeof block.codes[i].color);
    }
    return w->filled == ORL_LOD_BLOCKS ? flush_page(w) : ORL_OK;
}

static enum orl_result add_blocks(struct writer *w, size_t part)
{
    struct orl_points points = {0};
    float *scales = NULL;
    uint32_t *order = NULL;
    size_t count = 0;
    enum orl_result result = orl_point_parts_read(&w->parts, part, false, &points, &scales);
    if (result == ORL_OK && w->parts.flat)
        orl_points_apply_limits(&w->limits, scales, &points);
    if (result == ORL_OK) {
        orl_points_drop_flat(&points);
        result = orl_point_order(w->log, &points, &w->parts.cube, ORL_BLOCK_POINTS, &order, &count);
    }
    for (size_t i = 0; result == ORL_OK && i < count; i += ORL_BLOCK_POINTS)
        result = add_block(w, &points, order + i);
    free(order);
    free(scales);
    orl_points_finish(&points);
    return result;
}

// --- coarser levels ---

// Takes point i of a block, if it has as many, enlarged to cover the area of those left out.
static void take_point(const struct orl_lod_data *page, size_t b, int i, struct orl_points *taken)
{
    float count = page->blocks[b][1][3], drawn = fminf(count, TAKEN);
    if ((float)i < count && orl_lod_decode(page, b, (size_t)i, taken))
        taken->radius[taken->count++] *= sqrtf(count / drawn);
}

// Adds the parent of ORL_LOD_CHILDREN blocks from `first` on. It takes one point of each in turn, the
// blocks in bit-reversed order, so that any first part of the parent is spread evenly, too.
static enum orl_result add_parent(struct writer *w, size_t first)
{
    static const size_t turns[ORL_LOD_CHILDREN] = {0, 4, 2, 6, 1, 5, 3, 7};
    uint32_t order[ORL_BLOCK_POINTS];
    w->taken.count = 0;
    for (int i = 0; i < TAKEN; i++)
        for (int turn = 0; turn < ORL_LOD_CHILDREN; turn++)
            take_point(w->below, first + turns[turn], i, &w->taken);
    for (size_t i = 0; i < ORL_BLOCK_POINTS; i++)
        order[i] = i < w->taken.count ? (uint32_t)i : UINT32_MAX;
    return add_block(w, &w->taken, order);
}

static enum orl_result add_parents(struct writer *w, size_t page)
{
    FILE *file = w->out.stream;
    off_t size = (off_t)sizeof *w->page, at = LOD_PAGES_AT + size * (off_t)page;
    if (orl_progress_cancelled(w->progress))
        return ORL_ERR_CANCELLED;
    if (fseeko(file, at, SEEK_SET) != 0 || fread(w->below, sizeof *w->below, 1, file) != 1 ||
        fseeko(file, LOD_PAGES_AT + size * (off_t)w->page_count, SEEK_SET) != 0)
        return orl_file_failed(w->log, w->path);
    for (size_t b = 0; b < ORL_LOD_BLOCKS && w->below->blocks[b][1][3] > 0; b += ORL_LOD_CHILDREN)
        ORL_TRY(add_parent(w, b));
    return ORL_OK;
}

// The table goes behind the pages, and the header before them.
static enum orl_result write_table(struct writer *w, struct lod_header *h)
{
    FILE *file = w->out.stream;
    for (size_t i = 0; i < h->levels[0].count; i++)
        h->points += w->pages[i].count;
    if (!h->points)
        return orl_fail(w->log, ORL_ERR_DATA, "%s: no usable points", w->path);
    h->page_count = w->page_count;
    h->table_at = LOD_PAGES_AT + h->page_count * sizeof(struct orl_lod_data);
    h->table_hash = XXH3_64bits(w->pages, w->page_count * sizeof *w->pages);
    bool written = fwrite(w->pages, sizeof *w->pages, w->page_count, file) == w->page_count &&
                   fseeko(file, 0, SEEK_SET) == 0 && fwrite(h, sizeof *h, 1, file) == 1;
    return written ? ORL_OK : orl_file_failed(w->log, w->path);
}

static enum orl_result finish_levels(struct writer *w)
{
    struct lod_header header = {.block_points = ORL_BLOCK_POINTS, .page_blocks = ORL_LOD_BLOCKS,
                                .children = ORL_LOD_CHILDREN};
    memcpy(header.magic, LOD_MAGIC, sizeof header.magic); // without its end
    for (size_t first = 0, count = 2; count > 1; first += count) {
        ORL_TRY(flush_page(w));
        count = w->page_count - first;
        ORL_REQUIRE(w->log, header.level_count < ORL_LOD_LEVELS_MAX);
        header.levels[header.level_count++] = (struct orl_lod_level){(uint32_t)first, (uint32_t)count};
        for (size_t i = 0; count > 1 && i < count; i++)
            ORL_TRY(add_parents(w, first + i));
    }
    return write_table(w, &header);
}

// --- the whole ---

uint64_t orl_lod_most_in_memory(size_t max_bytes)
{
    return orl_point_parts_max(max_bytes);
}

// Says how much disk is needed before any of it is taken.
static enum orl_result check_disk(const struct writer *w, const char *ply)
{
    static const double page_bytes = 12.5, coarser = 1.0 / 7; // of a point
    struct orl_point_stream *stream = NULL;
    struct statvfs disk;
    uint64_t total = 0;
    enum orl_result result = orl_point_stream_open(w->log, ply, &stream, &total);
    orl_point_stream_close(&stream);
    if (result != ORL_OK || fstatvfs(w->out.fd, &disk) != 0)
        return result; // the size of some file systems is unknown
    double have = (double)disk.f_bavail * (double)disk.f_frsize;
    double pages = (double)total * page_bytes * (1 + coarser);
    double need = orl_point_parts_bytes((double)total) + pages;
    if (need > have)
        return orl_fail(w->log, ORL_ERR_IO, "%s: sorting %llu points takes about %.0f MiB and the "
                        "disk has %.0f MiB left", w->path, (unsigned long long)total,
                        need / (1 << 20), have / (1 << 20));
    orl_logf(w->log, ORL_LOG_INFO, "%s: sorting %llu points takes about %.0f MiB of disk; %.0f MiB "
             "are free", w->path, (unsigned long long)total, need / (1 << 20), have / (1 << 20));
    return ORL_OK;
}

static enum orl_result begin(struct writer *w)
{
    w->page = orl_array(w->log, 1, sizeof *w->page);
    w->below = orl_array(w->log, 1, sizeof *w->below);
    ORL_TRY_MEMORY(w->page && w->below);
    ORL_TRY(orl_points_init(w->log, &w->taken, ORL_BLOCK_POINTS));
    ORL_TRY(orl_atomic_open(w->log, w->path, &w->out));
    return fseeko(w->out.stream, LOD_PAGES_AT, SEEK_SET) == 0 ? ORL_OK : orl_file_failed(w->log, w->path);
}

static void finish(struct writer *w)
{
    orl_atomic_abort(&w->out);
    orl_point_parts_finish(&w->parts);
    orl_disc_sizes_finish(&w->sizes);
    orl_points_finish(&w->taken);
    free(w->page);
    free(w->below);
    free(w->pages);
}

enum orl_result orl_lod_write(const struct orl_log *log, const struct orl_progress *progress,
                              const struct orl_lod_params *params, const char *ply,
                              const char *path)
{
    struct writer w = {.log = log, .progress = progress, .params = params, .path = path};
    enum orl_result result = begin(&w);
    ORL_THEN(result, check_disk(&w, ply));
    ORL_THEN(result, orl_point_parts_make(log, progress, ply, path, params->max_bytes, &w.parts));
    ORL_THEN(result, find_radii(&w));
    ORL_THEN(result, for_parts(&w, "blocks", add_blocks));
    ORL_THEN(result, finish_levels(&w));
    ORL_THEN(result, orl_atomic_commit(log, &w.out));
    finish(&w);
    return result;
}
