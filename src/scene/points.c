#include "oriel/points.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "oriel/camera.h"
#include "scene/point_stream.h"

enum orl_result orl_points_init(const struct orl_log *log, struct orl_points *points, size_t count)
{
    memset(points, 0, sizeof *points);
    points->count = count;
    points->position = orl_array(log, count, sizeof *points->position);
    points->normal = orl_array(log, count, sizeof *points->normal);
    points->radius = orl_array(log, count, sizeof *points->radius);
    points->color = orl_array(log, count, sizeof *points->color);
    points->photographs = orl_array(log, count, sizeof *points->photographs);
    if (points->position && points->normal && points->radius && points->color &&
        points->photographs)
        return ORL_OK;
    orl_points_finish(points);
    return ORL_ERR_MEMORY;
}

void orl_points_finish(struct orl_points *points)
{
    if (!points)
        return;
    free(points->position);
    free(points->normal);
    free(points->radius);
    free(points->color);
    free(points->photographs);
    memset(points, 0, sizeof *points);
}

void orl_points_copy(const struct orl_points *from, size_t i, struct orl_points *to, size_t k)
{
    memmove(to->position[k], from->position[i], sizeof *to->position);
    memmove(to->normal[k], from->normal[i], sizeof *to->normal);
    memmove(to->color[k], from->color[i], sizeof *to->color);
    to->radius[k] = from->radius[i];
    to->photographs[k] = from->photographs[i];
}

bool orl_point_usable(const float position[3])
{
    const float most = (float)ORL_WORLD_MAX;
    return fabsf(position[0]) <= most && fabsf(position[1]) <= most && fabsf(position[2]) <= most;
}

void orl_points_drop_unusable(const struct orl_log *log, struct orl_points *points)
{
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i++)
        if (orl_point_usable(points->position[i]))
            orl_points_copy(points, i, points, kept++);
    if (kept < points->count)
        orl_logf(log, ORL_LOG_WARNING, "%zu of %zu points are not finite or absurdly far: dropped",
                 points->count - kept, points->count);
    points->count = kept;
}

// Size of the largest record in the file, which is packed: three doubles and three floats, a colour,
// a radius and a count.
enum { RECORD_SIZE_MAX = 3 * 8 + 3 * 4 + 3 + 4 + 1 };

// Returns the record's size.
static size_t pack_point(const struct orl_points *points, size_t i, bool small,
                         const double *origin, uint8_t record[RECORD_SIZE_MAX])
{
    size_t at = 0;
    for (int k = 0; k < 3; k++) {
        const double far = origin ? origin[k] + (double)points->position[i][k] : 0;
        size_t size = origin ? sizeof far : sizeof points->position[i][k];
        memcpy(record + at, origin ? (const void *)&far : &points->position[i][k], size);
        at += size;
    }
    for (int k = 0; small && k < 3; k++)
        record[at++] = (uint8_t)(int8_t)lrintf(127 * points->normal[i][k]);
    if (!small) {
        memcpy(record + at, points->normal[i], 12);
        at += 12;
    }
    memcpy(record + at, points->color[i], 3);
    memcpy(record + at + 3, &points->radius[i], 4);
    at += 7;
    if (!small)
        record[at++] = points->photographs[i];
    return at;
}

static void write_header(FILE *stream, uint64_t count, bool small, bool far)
{
    const char *normal = small ? "char" : "float", *position = far ? "double" : "float";
    fprintf(stream, "ply\nformat binary_little_endian 1.0\n"
                    "element vertex %llu\n"
                    "property %s x\nproperty %s y\nproperty %s z\n"
                    "property %s nx\nproperty %s ny\nproperty %s nz\n"
                    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                    "property float radius\n%send_header\n",
            (unsigned long long)count, position, position, position, normal, normal, normal,
            small ? "" : "property uchar photographs\n");
}

enum orl_result orl_point_writer_begin(const struct orl_log *log, const char *path, uint64_t count,
                                       bool small, const double *origin, struct orl_point_writer *writer)
{
    *writer = (struct orl_point_writer){.log = log, .path = path, .left = count, .small = small,
                                        .origin = origin};
    ORL_TRY(orl_atomic_open(log, path, &writer->file));
    write_header(writer->file.stream, count, small, origin);
    return ORL_OK;
}

enum orl_result orl_point_writer_add(struct orl_point_writer *writer,
                                     const struct orl_points *points)
{
    ORL_REQUIRE(writer->log, points->count <= writer->left);
    writer->left -= points->count;
    for (size_t i = 0; i < points->count; i++) {
        uint8_t record[RECORD_SIZE_MAX];
        size_t size = pack_point(points, i, writer->small, writer->origin, record);
        if (fwrite(record, size, 1, writer->file.stream) != 1)
            return orl_file_failed(writer->log, writer->path);
    }
    return ORL_OK;
}

enum orl_result orl_point_writer_end(struct orl_point_writer *writer)
{
    ORL_REQUIRE(writer->log, !writer->left);
    return orl_atomic_commit(writer->log, &writer->file);
}

enum orl_result orl_points_write(const struct orl_log *log, const char *path,
                                 const struct orl_points *points, bool small, const double *origin)
{
    struct orl_point_writer writer;
    bool far = origin && (origin[0] != 0 || origin[1] != 0 || origin[2] != 0);
    enum orl_result result =
        orl_point_writer_begin(log, path, points->count, small, far ? origin : NULL, &writer);
    ORL_THEN(result, orl_point_writer_add(&writer, points));
    ORL_THEN(result, orl_point_writer_end(&writer));
    orl_atomic_abort(&writer.file);
    return result;
}

size_t orl_points_drop_flat(struct orl_points *points)
{
    size_t kept = 0, all = points->count;
    for (size_t i = 0; i < all; i++)
        if (points->radius[i] > 0)
            orl_points_copy(points, i, points, kept++);
    points->count = kept;
    return all - kept;
}
