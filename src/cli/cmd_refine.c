// oriel refine: adjusts soft splats to a scene's training photographs.
#include <stdio.h>

#include "cli/command.h"
#include "eval/refine.h"

#define REFINE_OPTIONS(ROW) \
    ROW(steps, "steps", INT(30, 1, 10000, "N"), "steps for each photograph") \
    ROW(splats, "splats", INT(300000, 1000, 10000000, "N"), "splats to begin with, at most") \
    ROW(size_divide, "size-divide", INT(1, 1, 16, "N"), "compare at 1/N of the photographs' size") \
    ROW(budget_s, "budget", NUMBER(0, 0, 1e6, "SECONDS"), \
        "start no step after so long; default: none") \
    ROW(seed, "seed", INT(1, 0, 1000000, "N"), "of all random choices")
COMMAND_OPTIONS(refine_options, REFINE_OPTIONS)

static void print(const struct orl_refine_report *r)
{
    printf("%zu splats, of %zu on surfaces and %zu far ones; %d steps on %zu photographs, loss %.4f\n", r->splats,
           r->points, r->far, r->steps, r->photographs, r->loss);
    printf("%zu photographs that they had not seen, each drawn without itself: %.3f dB without splats", r->checks,
           r->before_psnr_db);
    if (r->share > 0)
        printf(", %.3f with --set soft=%.2g --set soft_mix=%.2g%s\n", r->psnr_db, r->share, r->mix_share,
               r->kept ? ", which the scene takes from now on" : "");
    else
        printf(", and no better with any share of them: the scene is drawn without\n");
}

static enum orl_result run_refine(struct call *call)
{
    const struct refine_options *o = call->options;
    struct orl_refine_report report = {0};
    struct orl_refine_params params = {
        .size_divide = o->size_divide, .steps = o->steps, .splats = o->splats, .budget_s = o->budget_s,
        .seed = (uint64_t)o->seed, .progress = call->progress};
    enum orl_result result = command_scene(call, NULL);
    ORL_THEN(result, orl_choice_make(call->log, call->scene, ORL_SAMPLE_SRGB, NULL, &(struct orl_names){0},
                                     &params.choice));
    ORL_THEN(result, command_device(call));
    ORL_THEN(result, orl_refine(call->gpu, call->scene, &params, &report));
    if (result == ORL_OK)
        print(&report);
    return result;
}

const struct command command_refine = {
    .name = "refine", .group = COMMAND_FIT,
    .brief = "adjust soft splats to a scene's photographs",
    .usage = "SCENE [options]",
    .summary = "Makes SCENE/soft.ply: ellipsoids of soft opacity that begin at the scene's points and are\n"
               "adjusted by descent on its training photographs. They mend what stereo cannot see. How much of\n"
               "them pictures take is found on photographs that they have not seen, and kept in scene.json;\n"
               "--set soft=0 draws without them. Held-out photographs take no part.",
    COMMAND_TABLE(refine_options), .inputs_min = 1, .inputs_max = 1, .run = run_refine,
};
