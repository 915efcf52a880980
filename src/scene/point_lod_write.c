// Writing points.lod: the points are distributed on disk to parts of the Morton curve, and each part
// is then sorted in memory.
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/point_lod_internal.h"
#include "scene/point_radii.h"
#include "scene/point_stream.h"

enum {
    CELL_BITS = 18, // of the Morton code: cells that are counted
    CELLS = 1 << CELL_BITS,
    READ_POINTS = 1 << 16,   // read at once
    SAMPLE_READS = 64,       // to find the extent of the cloud
    SAMPLE_POINTS = 4096,    // each
    POINT_BYTES = 160,       // of memory for a point of a part: radii, order, blocks
    LEAST_PART = 1 << 16,    // points
    MOST_PART = 1 << 24,
    BUFFER_RECORDS = 2048,   // of a part, written at once
};

struct record {
    float position[3], normal[3], radius;
    uint8_t color[3], photographs;
};

// A part of the curve: its records lie together on disk.
struct part {
    uint64_t first, count; // records
    uint64_t written;      // of them, without those in the buffer
    struct record *buffer; // BUFFER_RECORDS
    size_t buffered;
};

struct writer {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct orl_lod_params *params;
    struct orl_point_stream *stream;
    uint64_t total; // records of the PLY
    struct point_cube cube;
    uint64_t *counts;      // of points in each cell
    uint32_t *part_of;     // each cell
    struct part *parts;
    size_t part_count;
    struct orl_points read; // READ_POINTS
    struct orl_atomic_file sorted, out;
    FILE *file;            // of out
    struct lod_levels *levels;
    const char *path;
};

static enum orl_result failed(const struct writer *w)
{
    return orl_fail(w->log, ORL_ERR_IO, "%s: %s", w->path, strerror(errno));
}

static uint32_t cell_of(const struct writer *w, const float position[3])
{
    return (uint32_t)(orl_point_cube_morton(&w->cube, position) >> (63 - CELL_BITS));
}

// --- extent and cells ---

// The cube of a sample that is read here and there.
static enum orl_result find_cube(struct writer *w)
{
    struct orl_points sample;
    uint64_t step = w->total / SAMPLE_READS;
    size_t count = 0, read;
    enum orl_result result =
        orl_points_init(w->log, &sample, (size_t)SAMPLE_READS * SAMPLE_POINTS);
    for (uint64_t k = 0; result == ORL_OK && k < SAMPLE_READS; k++) {
        if (step > SAMPLE_POINTS)
            result = orl_point_stream_seek(w->stream, k * step);
        if (result == ORL_OK)
            result = orl_point_stream_next(w->stream, SAMPLE_POINTS, &w->read, &read);
        for (size_t i = 0; result == ORL_OK && i < w->read.count; i++)
            orl_points_copy(&w->read, i, &sample, count++);
    }
    sample.count = count;
    if (result == ORL_OK && !count)
        result = orl_fail(w->log, ORL_ERR_DATA, "%s: no usable points", w->path);
    if (result == ORL_OK)
        result = orl_point_cube_find(w->log, &sample, &w->cube);
    orl_points_finish(&sample);
    return result;
}

// Reads all points, a part of the file at a time.
static enum orl_result for_all(struct writer *w, const char *step,
                               enum orl_result (*use)(struct writer *w))
{
    uint64_t done = 0;
    size_t read = 1;
    enum orl_result result = orl_point_stream_seek(w->stream, 0);
    while (result == ORL_OK && read) {
        orl_progress_report(w->progress, step, (double)done, (double)w->total, NULL);
        result = orl_progress_cancelled(w->progress)
                     ? ORL_ERR_CANCELLED
                     : orl_point_stream_next(w->stream, READ_POINTS, &w->read, &read);
        if (result == ORL_OK)
            result = use(w);
        done += read;
    }
    return result;
}

static enum orl_result count_cells(struct writer *w)
{
    for (size_t i = 0; i < w->read.count; i++)
        w->counts[cell_of(w, w->read.position[i])]++;
    return ORL_OK;
}

// --- parts ---

static enum orl_result make_parts(struct writer *w)
{
    size_t bytes = w->params->max_bytes;
    uint64_t most, first = 0;
    if (!bytes) {
        uint64_t free_bytes = orl_memory_available();
        bytes = free_bytes / 2 < SIZE_MAX ? (size_t)(free_bytes / 2) : SIZE_MAX;
    }
    most = bytes / POINT_BYTES;
    most = most < LEAST_PART ? LEAST_PART : most > MOST_PART ? MOST_PART : most;
    size_t capacity = 0;
    for (size_t cell = 0; cell < CELLS; cell++) {
        struct part *last = w->part_count ? &w->parts[w->part_count - 1] : NULL;
        if (!last || last->count + w->counts[cell] > most) {
            enum orl_result result = orl_grow(w->log, (void **)&w->parts, &capacity,
                                              w->part_count + 1, sizeof *w->parts);
            if (result != ORL_OK)
                return result;
            last = &w->parts[w->part_count++];
            *last = (struct part){.first = first};
        }
        last->count += w->counts[cell];
        first += w->counts[cell];
        w->part_of[cell] = (uint32_t)(w->part_count - 1);
    }
    for (size_t i = 0; i < w->part_count; i++)
        if (!(w->parts[i].buffer = orl_array(w->log, BUFFER_RECORDS, sizeof(struct record))))
            return ORL_ERR_MEMORY;
    orl_logf(w->log, ORL_LOG_DEBUG, "%s: sorted in %zu parts", w->path, w->part_count);
    return ORL_OK;
}

static enum orl_result write_buffer(struct writer *w, struct part *part)
{
    const uint8_t *from = (const uint8_t *)part->buffer;
    size_t left = part->buffered * sizeof *part->buffer;
    off_t at = (off_t)((part->first + part->written) * sizeof *part->buffer);
    while (left) {
        ssize_t put = pwrite(w->sorted.fd, from, left, at);
        if (put < 0 && errno == EINTR)
            continue;
        if (put < 0)
            return failed(w);
        from += put;
        at += put;
        left -= (size_t)put;
    }
    part->written += part->buffered;
    part->buffered = 0;
    return ORL_OK;
}

static enum orl_result distribute(struct writer *w)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < w->read.count; i++) {
        const struct orl_points *p = &w->read;
        struct part *part = &w->parts[w->part_of[cell_of(w, p->position[i])]];
        struct record *r = &part->buffer[part->buffered++];
        memcpy(r->position, p->position[i], sizeof r->position);
        memcpy(r->normal, p->normal[i], sizeof r->normal);
        memcpy(r->color, p->color[i], sizeof r->color);
        r->radius = p->radius[i];
        r->photographs = p->photographs[i];
        if (part->buffered == BUFFER_RECORDS)
            result = write_buffer(w, part);
    }
    return result;
}

static enum orl_result flush_parts(struct writer *w)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < w->part_count; i++)
        result = write_buffer(w, &w->parts[i]);
    return result;
}

// --- blocks of a part ---

static enum orl_result read_part(const struct writer *w, const struct part *part,
                                 struct orl_points *points)
{
    enum orl_result result = orl_points_init(w->log, points, (size_t)part->count);
    points->count = 0;
    for (uint64_t at = 0; result == ORL_OK && at < part->count;) {
        uint64_t here = part->count - at < BUFFER_RECORDS ? part->count - at : BUFFER_RECORDS;
        size_t bytes = (size_t)here * sizeof(struct record);
        ssize_t got = pread(w->sorted.fd, part->buffer, bytes,
                            (off_t)((part->first + at) * sizeof(struct record)));
        if (got < 0 && errno == EINTR)
            continue;
        if (got != (ssize_t)bytes)
            return got < 0 ? failed(w)
                           : orl_fail(w->log, ORL_ERR_IO, "%s: cannot read it back", w->path);
        for (size_t i = 0; i < here; i++, points->count++) {
            const struct record *r = &part->buffer[i];
            memcpy(points->position[points->count], r->position, sizeof r->position);
            memcpy(points->normal[points->count], r->normal, sizeof r->normal);
            memcpy(points->color[points->count], r->color, sizeof r->color);
            points->radius[points->count] = r->radius;
            points->photographs[points->count] = r->photographs;
        }
        at += here;
    }
    return result;
}

static bool has_radii(const struct orl_points *points)
{
    for (size_t i = 0; i < points->count; i++)
        if (points->radius[i] > 0)
            return true;
    return false;
}

static enum orl_result add_part(struct writer *w, const struct part *part)
{
    struct orl_points points = {0};
    uint32_t *order = NULL;
    size_t count = 0;
    enum orl_result result = read_part(w, part, &points);
    if (result == ORL_OK && points.count && !has_radii(&points))
        result = orl_points_find_radii(w->log, w->params->views, w->params->view_count, &points);
    if (result == ORL_OK) {
        orl_points_drop_flat(&points);
        result = orl_point_order(w->log, &points, &w->cube, &order, &count);
    }
    for (size_t i = 0; result == ORL_OK && i < count; i += ORL_BLOCK_POINTS) {
        struct point_block block;
        orl_point_block_make(&points, order + i, &block);
        result = orl_lod_levels_add(w->levels, &block);
    }
    free(order);
    orl_points_finish(&points);
    return result;
}

static enum orl_result add_parts(struct writer *w)
{
    enum orl_result result = ORL_OK;
    uint64_t done = 0;
    for (size_t i = 0; result == ORL_OK && i < w->part_count; i++) {
        orl_progress_report(w->progress, "blocks", (double)done, (double)w->total, NULL);
        result = orl_progress_cancelled(w->progress) ? ORL_ERR_CANCELLED
                                                     : add_part(w, &w->parts[i]);
        done += w->parts[i].count;
    }
    orl_progress_report(w->progress, "blocks", (double)w->total, (double)w->total, NULL);
    return result;
}

// --- the whole ---

static enum orl_result begin(struct writer *w, const char *ply)
{
    enum orl_result result = orl_point_stream_open(w->log, ply, &w->stream, &w->total);
    if (result == ORL_OK)
        result = orl_points_init(w->log, &w->read, READ_POINTS);
    w->counts = orl_array(w->log, CELLS, sizeof *w->counts);
    w->part_of = orl_array(w->log, CELLS, sizeof *w->part_of);
    if (result == ORL_OK && !(w->counts && w->part_of))
        result = ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_atomic_begin(w->log, w->path, &w->sorted);
    if (result == ORL_OK)
        result = orl_atomic_begin(w->log, w->path, &w->out);
    if (result != ORL_OK)
        return result;
    w->file = orl_atomic_stream(&w->out);
    if (!w->file || fseeko(w->file, LOD_PAGES_AT, SEEK_SET) != 0)
        return failed(w);
    return orl_lod_levels_begin(w->log, w->path, w->file, &w->levels);
}

static void finish(struct writer *w)
{
    orl_lod_levels_destroy(&w->levels);
    if (w->file)
        fclose(w->file);
    orl_atomic_abort(&w->sorted);
    orl_atomic_abort(&w->out);
    for (size_t i = 0; i < w->part_count; i++)
        free(w->parts[i].buffer);
    free(w->parts);
    free(w->counts);
    free(w->part_of);
    orl_points_finish(&w->read);
    orl_point_stream_close(&w->stream);
}

enum orl_result orl_lod_write(const struct orl_log *log, const struct orl_progress *progress,
                              const struct orl_lod_params *params, const char *ply,
                              const char *path)
{
    struct writer w = {.log = log, .progress = progress, .params = params, .path = path};
    enum orl_result result;
    if ((result = begin(&w, ply)) == ORL_OK && (result = find_cube(&w)) == ORL_OK &&
        (result = for_all(&w, "count", count_cells)) == ORL_OK &&
        (result = make_parts(&w)) == ORL_OK &&
        (result = for_all(&w, "sort", distribute)) == ORL_OK &&
        (result = flush_parts(&w)) == ORL_OK && (result = add_parts(&w)) == ORL_OK)
        result = orl_lod_levels_end(w.levels);
    if (result == ORL_OK)
        result = orl_atomic_commit(log, &w.out);
    finish(&w);
    return result;
}
