// Makes a scene's soft splats: from its points, or else its mesh, and far ones where there are none, by descent on its
// training photographs; and finds how much of them its pictures take.
#ifndef ORL_EVAL_REFINE_H
#define ORL_EVAL_REFINE_H

#include "eval/choice.h"
#include "oriel/gpu.h"
#include "oriel/option_row.h"
#include "oriel/progress.h"
#include "oriel/scene.h"

// There are fewer splats for few or small photographs, and where device memory is short.
#define ORL_REFINE_OPTIONS(ROW) \
    ROW(steps, "steps", INT(0, 0, 10000, "N"), "steps for each photograph; default: 20, but 200 to 1200 in all") \
    ROW(splats, "splats", INT(300000, 1000, 10000000, "N"), "splats to begin with, at most") \
    ROW(size_divide, "size-divide", INT(1, 1, 16, "N"), "compare at 1/N of the photographs' size") \
    ROW(budget_s, "budget", NUMBER(0, 0, 1e6, "SECONDS"), \
        "start no step after so long; default: none") \
    ROW(seed, "seed", SEED, "of all random choices") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
struct orl_refine_params {
    ORL_REFINE_OPTIONS(ORL_OPTION_MEMBER)
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

// Writes SCENE/soft.ply, and the shares to scene.json. Held-out photographs take no part. Goes on where a run of the same
// settings was cut off; the result is that of a run that was not, unless a budget ends it. ORL_ERR_DATA: the scene has
// neither points nor a mesh, or fewer than three training photographs. ORL_ERR_GPU: max_vram_bytes are not enough.
enum orl_result orl_refine(struct orl_gpu *gpu, const struct orl_scene *scene, const struct orl_refine_params *params,
                           struct orl_refine_report *report) ORL_CHECK_RESULT;

#endif
