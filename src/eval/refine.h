// Makes a scene's soft splats: from its points, or else its mesh, and far ones where there are none, by descent on its
// training photographs; and finds how much of them its pictures take.
#ifndef ORL_EVAL_REFINE_H
#define ORL_EVAL_REFINE_H

#include "eval/choice.h"
#include "oriel/gpu.h"
#include "oriel/progress.h"
#include "oriel/scene.h"

struct orl_refine_params {
    int size_divide;     // photographs are used at 1/n of their size, [1, 16]
    int steps;           // per photograph
    double splats;       // that stand for the points, at most; there are fewer for few or small photographs
    double budget_s;     // 0: any
    uint64_t seed;
    struct orl_choice choice; // the method and options with which pictures are drawn
    const struct orl_progress *progress;
};

struct orl_refine_report {
    size_t photographs, points, far, splats; // on surfaces, far ones, and how many stayed
    int steps;
    double loss; // running mean over the last photographs
    // On photographs that the splats had not seen until then, each drawn without itself:
    size_t checks;                 // how many
    double share, mix_share;       // of the splats with which they came out best (opt.soft, opt.soft_mix)
    double psnr_db, before_psnr_db; // means with these, and without splats
    bool kept;                     // in scene.json; false: the folder has none
};

// Writes SCENE/soft.ply, and the shares to scene.json. Held-out photographs take no part. ORL_ERR_DATA: the scene has
// neither points nor a mesh, or fewer than three training photographs.
enum orl_result orl_refine(struct orl_gpu *gpu, const struct orl_scene *scene, const struct orl_refine_params *params,
                           struct orl_refine_report *report) ORL_CHECK_RESULT;

#endif
