// Private: points of a PLY file, a part at a time, for clouds larger than memory.
#ifndef ORL_SCENE_POINT_STREAM_H
#define ORL_SCENE_POINT_STREAM_H

#include "core/file.h"
#include "oriel/points.h"

struct orl_point_stream;
// Opens a binary PLY whose vertices come first and have no lists. *total: how many the header
// claims, which the file is long enough for.
enum orl_result orl_point_stream_open(const struct orl_log *log, const char *path,
                                      struct orl_point_stream **stream,
                                      uint64_t *total) ORL_CHECK_RESULT;
void orl_point_stream_close(struct orl_point_stream **stream);
// The next record to read.
enum orl_result orl_point_stream_seek(struct orl_point_stream *stream,
                                      uint64_t record) ORL_CHECK_RESULT;
// Reads the next `most` records, or as many as are left, as orl_points_read does. `points` has room
// for as many; its count becomes the number of those that are usable. *read: the number of records;
// 0: there are no more.
enum orl_result orl_point_stream_next(struct orl_point_stream *stream, size_t most,
                                      struct orl_points *points, size_t *read) ORL_CHECK_RESULT;

// Writes a file as orl_points_write does, a part at a time.
struct orl_point_writer {
    const struct orl_log *log;
    const char *path;
    struct orl_atomic_file file;
    uint64_t left; // points that are still to come
    bool small;
    const double *origin; // added to positions, which become doubles; NULL: floats as they are
};
// count: of all points. `path` must outlive the writer, whose file is released with orl_atomic_abort.
enum orl_result orl_point_writer_begin(const struct orl_log *log, const char *path, uint64_t count,
                                       bool small, const double *origin,
                                       struct orl_point_writer *writer) ORL_CHECK_RESULT;
enum orl_result orl_point_writer_add(struct orl_point_writer *writer,
                                     const struct orl_points *points) ORL_CHECK_RESULT;
// After all points: gives the file its name.
enum orl_result orl_point_writer_end(struct orl_point_writer *writer) ORL_CHECK_RESULT;

#endif
