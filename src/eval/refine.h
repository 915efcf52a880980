// Makes a scene's soft splats: from its points and far ones where there are none, by descent on its training
// photographs.
#ifndef ORL_EVAL_REFINE_H
#define ORL_EVAL_REFINE_H

#include "oriel/gpu.h"
#include "oriel/progress.h"
#include "oriel/scene.h"

struct orl_refine_params {
    int size_divide;     // photographs are used at 1/n of their size, [1, 16]
    int steps;           // per photograph
    double splats;       // about how many stand for the points; each pixel of photographs has at most one
    double budget_s;     // 0: any
    uint64_t seed;
    const struct orl_progress *progress;
};

struct orl_refine_report {
    size_t photographs, points, far, splats; // from points, far ones, and how many stayed
    int steps;
    double loss; // running mean over the last photographs
};

// Writes SCENE/soft.ply. Held-out photographs take no part. ORL_ERR_DATA: the scene has no points or no training
// photographs.
enum orl_result orl_refine(struct orl_gpu *gpu, const struct orl_scene *scene, const struct orl_refine_params *params,
                           struct orl_refine_report *report) ORL_CHECK_RESULT;

#endif
