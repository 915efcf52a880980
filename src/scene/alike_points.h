// Private: points at the same position, of which a search for neighbours needs only a few. A tree
// cannot part them, so that a search visits all of them each time.
#ifndef ORL_SCENE_ALIKE_POINTS_H
#define ORL_SCENE_ALIKE_POINTS_H

#include "oriel/points.h"

struct few_alike {
    const float (*position)[3];
    size_t count;
    int *index; // owned: of each position, among the points; NULL: all points are taken
    float (*own)[3]; // owned, or NULL
};

// Takes of the points at each position the first `most`, which is at most 255.
enum orl_result orl_points_few_alike(const struct orl_log *log, const struct orl_points *points,
                                     unsigned most, struct few_alike *few) ORL_CHECK_RESULT;
void orl_few_alike_finish(struct few_alike *few);
// The index among the points; -1 for what is not an index of the few.
static inline int orl_few_alike_point(const struct few_alike *few, int found)
{
    if (found < 0 || (size_t)found >= few->count)
        return -1;
    return few->index ? few->index[found] : found;
}

#endif
