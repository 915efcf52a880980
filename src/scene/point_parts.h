// Private: a cloud that is larger than memory, distributed on disk to parts of the Morton curve,
// each of which is read whole.
#ifndef ORL_SCENE_POINT_PARTS_H
#define ORL_SCENE_POINT_PARTS_H

#include "core/file.h"
#include "oriel/progress.h"
#include "scene/point_blocks.h"

struct point_part;

struct point_parts {
    const struct orl_log *log;
    const char *path;       // of what is made of them
    struct point_cube cube; // around all points
    struct point_part *parts;
    size_t count;
    uint64_t total;         // points of all parts
    bool flat;              // no point has a radius
    struct orl_atomic_file file; // beside `path`, with the parts; never takes its final name
};

// Reads the binary PLY twice, or up to four times where its points lie unevenly, and writes the parts, each of as many
// points as fit in `max_bytes`; more, with a warning, where so many lie at one place. Where no point has a radius, a part comes with the points around it, among which its own have their
// neighbours.
enum orl_result orl_point_parts_make(const struct orl_log *log, const struct orl_progress *progress,
                                     const char *ply, const char *path, size_t max_bytes,
                                     struct point_parts *parts) ORL_CHECK_RESULT;
void orl_point_parts_finish(struct point_parts *parts);
// Points of one part, without those around it.
size_t orl_point_parts_own(const struct point_parts *parts, size_t part);
// Reads a part: its own points first, then those around it if `around`. *scales: what
// orl_point_parts_write stored, of its own points; owned by the caller (free), like `points`.
enum orl_result orl_point_parts_read(const struct point_parts *parts, size_t part, bool around,
                                     struct orl_points *points, float **scales) ORL_CHECK_RESULT;
// Stores a part's own points anew, with a number for each.
enum orl_result orl_point_parts_write(const struct point_parts *parts, size_t part,
                                      const struct orl_points *points,
                                      const float *scales) ORL_CHECK_RESULT;
// Points of a part at most. max_bytes: of memory; 0: half of what is free.
uint64_t orl_point_parts_max(size_t max_bytes);
// Bytes of disk that the parts of this many points without radii take, about.
double orl_point_parts_bytes(double points);

#endif
