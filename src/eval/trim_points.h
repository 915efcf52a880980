// Which points a scene can do without: points are ranked by what they contribute to pictures, and a
// smaller cloud is made of the first of them.
#ifndef ORL_EVAL_TRIM_POINTS_H
#define ORL_EVAL_TRIM_POINTS_H

#include "oriel/progress.h"
#include "oriel/render.h"

struct orl_point_ranking {
    uint32_t *order; // owned: indices into the scene's points, the most important first
    uint32_t *pixels; // owned, per point of the scene: pixels of all views that it wins
    size_t count;
};
// Ranks by the views of training photographs and views between neighbours, at most `max_views` > 0. At
// every pixel of coarser and coarser pictures of a view one point of the nearest surface is chosen:
// that which wins the most pixels of all views. A point ranks by the coarsest picture that it is
// chosen in, then by its pixels. So the points that no view shows are last, those that only full
// resolution needs are before them, and a first part of the order is spread evenly over pictures.
enum orl_result orl_point_ranking_make(struct orl_gpu *gpu, const struct orl_scene *scene,
                                       size_t max_views, const struct orl_progress *progress,
                                       struct orl_point_ranking *ranking) ORL_CHECK_RESULT;
void orl_point_ranking_finish(struct orl_point_ranking *ranking);

// Makes a cloud of the first `count` points of `order`, with radii that close the gaps. Each point
// takes the place of the points that it stands for: along its normal it moves to their mean, and its
// normal and colour become theirs.
enum orl_result orl_points_thin_out(const struct orl_log *log, const struct orl_points *from,
                                    const uint32_t *order, size_t count,
                                    struct orl_points *to) ORL_CHECK_RESULT;

#endif
