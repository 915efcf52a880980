// Co-visible samples: the colours of one scene point in several photographs.
#ifndef ORL_PREPROCESS_SAMPLES_H
#define ORL_PREPROCESS_SAMPLES_H

#include "oriel/progress.h"
#include "oriel/points.h"
#include "preprocess/expose/expose.h"

// What one photograph shows of a point: the mean of a patch without edges that does not clip in
// every channel.
struct orl_observation {
    uint32_t point, photo;
    float value[3]; // 8-bit values, [0, 255]; undefined in channels that clip
    uint8_t clipped; // bit c: channel c has clipped or black pixels
    float r2;       // squared distance from the principal point, in half diagonals
};

enum { ORL_SAMPLES_PER_POINT = 32 }; // more add little, and the cost of alignment grows with their square

struct orl_samples {
    size_t point_count, count;
    size_t *first; // point_count + 1: where a point's observations begin
    struct orl_observation *items; // sorted by point, then by photograph
};

// Visibility is tested against a depth buffer of all points. A patch has the same size in the scene
// in every photograph: the point's radius to either side. Only points that at least two photographs
// show are kept. Photographs are read one at a time.
enum orl_result orl_samples_take(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *dir, const struct orl_exposed *photos,
                                 size_t photo_count, const struct orl_points *points,
                                 struct orl_samples *samples) ORL_CHECK_RESULT;
void orl_samples_finish(struct orl_samples *samples);
// Sorts observations by their points and photographs, and takes those of points with two or more. A point keeps at most
// ORL_SAMPLES_PER_POINT of them.
enum orl_result orl_samples_collect(const struct orl_log *log, struct orl_observation *observations, size_t count,
                                    struct orl_samples *samples) ORL_CHECK_RESULT;

#endif
