// The nearest points of a cloud (FLANN, an exact search).
#ifndef ORL_SCENE_NEAREST_POINTS_H
#define ORL_SCENE_NEAREST_POINTS_H

#include "oriel/points.h"

// FLANN counts points, and the bytes of its tree, in an int.
enum { ORL_SEARCH_POINTS_MAX = 1 << 27 };

// Finds for each of `queries` its nearest point: found[i] is an index into `points`, dist2[i] the
// square of the distance. All must be usable (orl_point_usable), and `points` not empty, and no more than
// ORL_SEARCH_POINTS_MAX; there may be any number of queries.
enum orl_result orl_points_nearest(const struct orl_log *log, const struct orl_points *points,
                                   const struct orl_points *queries, int *found,
                                   float *dist2) ORL_CHECK_RESULT;

// --- private ---

// Points of which those at the same position are left out but for the first `most`, 255 at most: a tree cannot part them, so
// that a search visits all of them each time.
struct few_alike {
    const float (*position)[3];
    size_t count;
    int *index; // owned: of each position, among the points; NULL: all points are taken
    float (*own)[3]; // owned, or NULL
};
enum orl_result orl_points_few_alike(const struct orl_log *log, const struct orl_points *points,
                                     unsigned most, struct few_alike *few) ORL_CHECK_RESULT;
void orl_few_alike_finish(struct few_alike *few);

// A search for the `neighbours` nearest of some points, of which there are as many, nearest first.
struct point_search {
    const struct orl_log *log;
    int neighbours;
    struct few_alike few; // what is searched among
    void *index;          // FLANN's, owned
};
// Of at most ORL_SEARCH_POINTS_MAX points, which must stay as they are. The caller closes the search, on failure too.
enum orl_result orl_point_search_open(const struct orl_log *log, const struct orl_points *points, int neighbours,
                                      struct point_search *search) ORL_CHECK_RESULT;
void orl_point_search_close(struct point_search *search);
// found: of each of `count` queries its neighbours' indices among the points; dist2: the squares of the distances.
enum orl_result orl_point_search_find(const struct point_search *search, float (*queries)[3], size_t count, int *found,
                                      float *dist2) ORL_CHECK_RESULT;

#endif
