#include "scene/point_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "scene/point_stream.h"

enum {
    AXIS_BITS = 6,            // of a cell's place along each axis
    MOST_AXIS_BITS = 8,       // where a cell would be more than a part may have
    READ_POINTS = 1 << 16,    // read at once
    SAMPLE_READS = 64,        // to find the extent of the cloud
    SAMPLE_POINTS = 4096,     // each
    POINT_BYTES = 160,        // of memory for a point of a part: radii, order, blocks
    LEAST_PART = 1 << 12,     // points
    MOST_PART = 1 << 24,
    MOST_FLAT_PART = 1 << 22, // where radii are found, which must be interruptible
    NEAR = 27,                // cells around a cell, and itself
    BUFFER_RECORDS = 512,     // of a run, written at once
};

struct record {
    float position[3], normal[3], radius, scale;
    uint8_t color[3], photographs;
};

// Records that lie together on disk.
struct run {
    uint64_t first, count;
    uint64_t written;      // of them, without those in the buffer
    struct record *buffer; // BUFFER_RECORDS
    size_t buffered;
};

struct point_part {
    struct run own, around;
};

struct maker {
    const struct orl_progress *progress;
    struct point_parts *parts;
    struct orl_point_stream *stream;
    uint64_t records;       // of the PLY
    size_t max_bytes;
    struct orl_points read; // READ_POINTS
    // The cube is divided into 1 << axis_bits cells along each axis, in the order of the Morton curve.
    unsigned axis_bits;
    uint64_t most;          // points of a part
    uint64_t *counts;       // of points in each cell
    uint32_t *part_of;      // each cell
    bool *border;           // of each cell: another part's points may be near
};

// --- extent ---

// The cube of a sample that is read here and there.
static enum orl_result find_cube(struct maker *m)
{
    const struct orl_log *log = m->parts->log;
    struct orl_points sample;
    uint64_t step = m->records / SAMPLE_READS;
    size_t count = 0, read;
    enum orl_result result = orl_points_init(log, &sample, (size_t)SAMPLE_READS * SAMPLE_POINTS);
    for (uint64_t k = 0; result == ORL_OK && k < SAMPLE_READS; k++) {
        if (step > SAMPLE_POINTS)
            result = orl_point_stream_seek(m->stream, k * step);
        ORL_THEN(result, orl_point_stream_next(m->stream, SAMPLE_POINTS, &m->read, &read));
        for (size_t i = 0; result == ORL_OK && i < m->read.count; i++)
            orl_points_copy(&m->read, i, &sample, count++);
    }
    sample.count = count;
    if (result == ORL_OK && !count)
        result = orl_fail(log, ORL_ERR_DATA, "%s: no usable points", m->parts->path);
    ORL_THEN(result, orl_point_cube_find(log, &sample, &m->parts->cube));
    orl_points_finish(&sample);
    return result;
}

// --- cells ---

static size_t cell_count(const struct maker *m)
{
    return (size_t)1 << 3 * m->axis_bits;
}

static uint32_t cell_at(const struct maker *m, const struct point_cube *cube, const float position[3])
{
    return (uint32_t)(orl_point_cube_morton(cube, position) >> (63 - 3 * m->axis_bits));
}

// Every third bit of a Morton code.
static uint32_t gather_bits(uint32_t code)
{
    uint32_t value = 0;
    for (int k = 0; k < MOST_AXIS_BITS; k++)
        value |= (code >> 3 * k & 1) << k;
    return value;
}

// The cells around one, and itself; cells outside the cube are left out. How many.
static size_t find_near(const struct maker *m, uint32_t cell, uint32_t near[NEAR])
{
    const struct point_cube units = {.side = 1 << m->axis_bits}; // in which cells are 1 wide
    size_t count = 0;
    for (int i = 0; i < NEAR; i++) {
        const int step[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        float to[3];
        bool inside = true;
        for (int k = 0; k < 3; k++) {
            to[k] = (float)((int)gather_bits(cell >> k) + step[k]);
            inside = inside && to[k] >= 0 && (double)to[k] < units.side;
        }
        if (inside)
            near[count++] = cell_at(m, &units, to);
    }
    return count;
}

// Is the point so close to the cell that it may be a neighbour of one of the cell's points? A few
// times the distance that they have if they lie on a surface, and a cell at most.
static bool reaches(const struct maker *m, const float position[3], uint32_t cell)
{
    static const double times = 8;
    double side = ldexp(m->parts->cube.side, -(int)m->axis_bits), distance2 = 0;
    for (int k = 0; k < 3; k++) {
        double low = m->parts->cube.low[k] + side * (double)gather_bits(cell >> k);
        double first = m->parts->cube.low[k], last = first + m->parts->cube.side;
        double p = fmin(fmax((double)position[k], first), last); // cells of the border are endless
        double d = fmax(fmax(low - p, p - low - side), 0);
        distance2 += d * d;
    }
    return distance2 <= side * side * fmin(1, times * times / (double)m->counts[cell]);
}

// The other parts that the point, which lies in the cell, is near to; NULL: any point of the cell may
// be near to. How many.
static size_t find_others(const struct maker *m, const float position[3], uint32_t cell,
                          uint32_t others[NEAR])
{
    uint32_t near[NEAR];
    size_t count = 0, near_count = find_near(m, cell, near);
    for (size_t i = 0; i < near_count; i++) {
        uint32_t part = m->part_of[near[i]];
        bool known = part == m->part_of[cell] || !m->counts[near[i]];
        for (size_t k = 0; k < count; k++)
            known = known || others[k] == part;
        if (!known && (!position || reaches(m, position, near[i])))
            others[count++] = part;
    }
    return count;
}

// Reads all points, a part of the file at a time.
static enum orl_result for_all(struct maker *m, const char *step,
                               enum orl_result (*use)(struct maker *m))
{
    uint64_t done = 0;
    size_t read = 1;
    enum orl_result result = orl_point_stream_seek(m->stream, 0);
    while (result == ORL_OK && read) {
        orl_progress_report(m->progress, step, (double)done, (double)m->records, NULL);
        result = orl_progress_cancelled(m->progress)
                     ? ORL_ERR_CANCELLED
                     : orl_point_stream_next(m->stream, READ_POINTS, &m->read, &read);
        ORL_THEN(result, use(m));
        done += read;
    }
    return result;
}

static enum orl_result count_cells(struct maker *m)
{
    for (size_t i = 0; i < m->read.count; i++) {
        m->counts[cell_at(m, &m->parts->cube, m->read.position[i])]++;
        m->parts->flat = m->parts->flat && !(m->read.radius[i] > 0);
    }
    m->parts->total += m->read.count;
    return ORL_OK;
}

// --- parts ---

uint64_t orl_point_parts_max(size_t max_bytes)
{
    uint64_t most = (max_bytes ? max_bytes : orl_memory_available() / 2) / POINT_BYTES;
    return most < LEAST_PART ? LEAST_PART : most;
}

// Counts the points of each cell, and in *largest those of the fullest one.
static enum orl_result count_points(struct maker *m, uint64_t *largest)
{
    const struct orl_log *log = m->parts->log;
    free(m->counts);
    m->counts = orl_array(log, cell_count(m), sizeof *m->counts);
    ORL_TRY_MEMORY(m->counts);
    m->parts->total = *largest = 0;
    ORL_TRY(for_all(m, "count", count_cells));
    for (size_t cell = 0; cell < cell_count(m); cell++)
        *largest = m->counts[cell] > *largest ? m->counts[cell] : *largest;
    uint64_t limit = m->parts->flat ? MOST_FLAT_PART : MOST_PART;
    m->most = orl_point_parts_max(m->max_bytes);
    m->most = m->most < limit ? m->most : limit;
    return ORL_OK;
}

// Halves the cells as long as one has more points than a part may have, and as that helps: points at one place
// stay in one cell.
static enum orl_result choose_cells(struct maker *m)
{
    const struct point_parts *parts = m->parts;
    uint64_t largest = UINT64_MAX, before;
    m->axis_bits = AXIS_BITS - 1;
    do {
        before = largest;
        m->axis_bits++;
        ORL_TRY(count_points(m, &largest));
    } while (largest > m->most && largest <= before / 2 && m->axis_bits < MOST_AXIS_BITS);
    if (largest > m->most)
        orl_logf(parts->log, ORL_LOG_WARNING, "%s: %llu points lie so close together that they are sorted at once, which "
                 "takes about %llu MiB of memory", parts->path, (unsigned long long)largest,
                 (unsigned long long)(largest * POINT_BYTES >> 20));
    m->part_of = orl_array(parts->log, cell_count(m), sizeof *m->part_of);
    m->border = orl_array(parts->log, cell_count(m), sizeof *m->border);
    return m->part_of && m->border ? ORL_OK : ORL_ERR_MEMORY;
}

static enum orl_result assign_cells(struct maker *m)
{
    struct point_parts *parts = m->parts;
    size_t capacity = 0;
    for (size_t cell = 0; cell < cell_count(m); cell++) {
        struct point_part *last = parts->count ? &parts->parts[parts->count - 1] : NULL;
        if (!m->counts[cell])
            continue;
        if (!last || last->own.count + m->counts[cell] > m->most) {
            ORL_TRY(ORL_GROW(parts->log, parts->parts, capacity, parts->count));
            last = &parts->parts[parts->count++];
            *last = (struct point_part){0};
        }
        last->own.count += m->counts[cell];
        m->part_of[cell] = (uint32_t)(parts->count - 1);
    }
    return ORL_OK;
}

// Makes room for all points of the cells around each part. Those that are too far away are never
// written, and a file's holes take no disk.
static void count_around(struct maker *m, uint32_t cell)
{
    uint32_t parts[NEAR];
    size_t count = find_others(m, NULL, cell, parts);
    m->border[cell] = count > 0;
    for (size_t k = 0; k < count; k++)
        m->parts->parts[parts[k]].around.count += m->counts[cell];
}

static enum orl_result lay_out(struct maker *m)
{
    struct point_parts *parts = m->parts;
    uint64_t first = 0;
    for (uint32_t cell = 0; parts->flat && cell < cell_count(m); cell++)
        if (m->counts[cell])
            count_around(m, cell);
    for (size_t i = 0; i < 2 * parts->count; i++) {
        struct point_part *part = &parts->parts[i / 2];
        struct run *run = i % 2 ? &part->around : &part->own;
        run->first = first;
        first += run->count;
        run->buffer = orl_array(parts->log, BUFFER_RECORDS, sizeof *run->buffer);
        ORL_TRY_MEMORY(run->buffer);
    }
    return ORL_OK;
}

// --- the file ---

// Goes to record `index` of a run.
static bool seek(const struct point_parts *parts, const struct run *run, uint64_t index)
{
    return fseeko(parts->file.stream, (off_t)((run->first + index) * sizeof(struct record)), SEEK_SET) == 0;
}

static enum orl_result write_buffer(const struct point_parts *parts, struct run *run)
{
    if (!seek(parts, run, run->written) ||
        fwrite(run->buffer, sizeof *run->buffer, run->buffered, parts->file.stream) != run->buffered)
        return orl_file_failed(parts->log, parts->path);
    run->written += run->buffered;
    run->buffered = 0;
    return ORL_OK;
}

static enum orl_result add_record(const struct point_parts *parts, struct run *run,
                                  const struct orl_points *points, size_t i, float scale)
{
    struct record *r = &run->buffer[run->buffered++];
    memcpy(r->position, points->position[i], sizeof r->position);
    memcpy(r->normal, points->normal[i], sizeof r->normal);
    memcpy(r->color, points->color[i], sizeof r->color);
    r->radius = points->radius[i];
    r->scale = scale;
    r->photographs = points->photographs[i];
    return run->buffered == BUFFER_RECORDS ? write_buffer(parts, run) : ORL_OK;
}

static enum orl_result distribute(struct maker *m)
{
    const struct point_parts *parts = m->parts;
    uint32_t others[NEAR];
    for (size_t i = 0; i < m->read.count; i++) {
        const float *position = m->read.position[i];
        uint32_t cell = cell_at(m, &parts->cube, position);
        size_t count = m->border[cell] ? find_others(m, position, cell, others) : 0;
        ORL_TRY(add_record(parts, &parts->parts[m->part_of[cell]].own, &m->read, i, 0));
        for (size_t k = 0; k < count; k++)
            ORL_TRY(add_record(parts, &parts->parts[others[k]].around, &m->read, i, 0));
    }
    return ORL_OK;
}

static enum orl_result flush(const struct point_parts *parts)
{
    enum orl_result result = ORL_OK;
    uint64_t around = 0;
    for (size_t i = 0; result == ORL_OK && i < 2 * parts->count; i++) {
        struct point_part *part = &parts->parts[i / 2];
        struct run *run = i % 2 ? &part->around : &part->own;
        result = write_buffer(parts, run);
        run->count = run->written;
        around += i % 2 ? run->count : 0;
    }
    orl_logf(parts->log, ORL_LOG_DEBUG, "%s: %llu points in %zu parts, %llu more around them",
             parts->path, (unsigned long long)parts->total, parts->count,
             (unsigned long long)around);
    return result;
}

enum orl_result orl_point_parts_make(const struct orl_log *log, const struct orl_progress *progress,
                                     const char *ply, const char *path, size_t max_bytes,
                                     struct point_parts *parts)
{
    struct maker m = {.progress = progress, .parts = parts, .max_bytes = max_bytes};
    *parts = (struct point_parts){.log = log, .path = path, .flat = true};
    enum orl_result result = orl_point_stream_open(log, ply, &m.stream, &m.records);
    ORL_THEN(result, orl_points_init(log, &m.read, READ_POINTS));
    ORL_THEN(result, orl_atomic_open(log, path, &parts->file));
    ORL_THEN(result, find_cube(&m));
    ORL_THEN(result, choose_cells(&m));
    ORL_THEN(result, assign_cells(&m));
    ORL_THEN(result, lay_out(&m));
    ORL_THEN(result, for_all(&m, "sort", distribute));
    ORL_THEN(result, flush(parts));
    free(m.counts);
    free(m.part_of);
    free(m.border);
    orl_points_finish(&m.read);
    orl_point_stream_close(&m.stream);
    if (result != ORL_OK)
        orl_point_parts_finish(parts);
    return result;
}

void orl_point_parts_finish(struct point_parts *parts)
{
    for (size_t i = 0; i < parts->count; i++) {
        free(parts->parts[i].own.buffer);
        free(parts->parts[i].around.buffer);
    }
    free(parts->parts);
    parts->parts = NULL;
    parts->count = 0;
    orl_atomic_abort(&parts->file);
}

double orl_point_parts_bytes(double points)
{
    static const double around = 0.35; // points around the parts, for each of their own
    return points * (1 + around) * sizeof(struct record);
}

// --- a part ---

size_t orl_point_parts_own(const struct point_parts *parts, size_t part)
{
    return (size_t)parts->parts[part].own.count;
}

static enum orl_result read_run(const struct point_parts *parts, const struct run *run,
                                struct orl_points *points, float *scales)
{
    for (uint64_t at = 0; at < run->count;) {
        uint64_t here = run->count - at < BUFFER_RECORDS ? run->count - at : BUFFER_RECORDS;
        if (!seek(parts, run, at) || fread(run->buffer, sizeof *run->buffer, here, parts->file.stream) != here)
            return orl_fail(parts->log, ORL_ERR_IO, "%s: cannot read its parts back", parts->path);
        for (size_t i = 0; i < here; i++, points->count++) {
            const struct record *r = &run->buffer[i];
            memcpy(points->position[points->count], r->position, sizeof r->position);
            memcpy(points->normal[points->count], r->normal, sizeof r->normal);
            memcpy(points->color[points->count], r->color, sizeof r->color);
            points->radius[points->count] = r->radius;
            points->photographs[points->count] = r->photographs;
            if (scales)
                scales[points->count] = r->scale;
        }
        at += here;
    }
    return ORL_OK;
}

enum orl_result orl_point_parts_read(const struct point_parts *parts, size_t index, bool around,
                                     struct orl_points *points, float **scales)
{
    const struct point_part *part = &parts->parts[index];
    size_t own = (size_t)part->own.count;
    enum orl_result result =
        orl_points_init(parts->log, points, own + (around ? (size_t)part->around.count : 0));
    *scales = orl_array(parts->log, own, sizeof **scales);
    points->count = 0;
    if (result == ORL_OK && !*scales)
        result = ORL_ERR_MEMORY;
    ORL_THEN(result, read_run(parts, &part->own, points, *scales));
    if (result == ORL_OK && around)
        result = read_run(parts, &part->around, points, NULL);
    if (result != ORL_OK) {
        orl_points_finish(points);
        free(*scales);
        *scales = NULL;
    }
    return result;
}

enum orl_result orl_point_parts_write(const struct point_parts *parts, size_t index,
                                      const struct orl_points *points, const float *scales)
{
    struct run *run = &parts->parts[index].own;
    run->written = 0;
    for (size_t i = 0; i < run->count; i++)
        ORL_TRY(add_record(parts, run, points, i, scales[i]));
    return write_buffer(parts, run);
}
