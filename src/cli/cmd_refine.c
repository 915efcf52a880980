// oriel refine: adjusts soft splats to a scene's training photographs.
#include <stdio.h>

#include "cli/command.h"
#include "eval/refine.h"

COMMAND_OPTIONS(refine_options, ORL_REFINE_OPTIONS)

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
    struct orl_refine_params params = {ORL_REFINE_OPTIONS(ORL_OPTION_COPY) .progress = call->progress};
    ORL_TRY(command_scene(call, NULL));
    ORL_TRY(orl_choice_make(call->log, call->scene, ORL_SAMPLE_SRGB, NULL, &(struct orl_names){0},
                            &params.choice));
    ORL_TRY(command_device(call));
    ORL_TRY(orl_refine(call->gpu, call->scene, &params, &report));
    print(&report);
    return ORL_OK;
}

const struct command command_refine = {
    .name = "refine", .group = COMMAND_FIT,
    .brief = "adjust soft splats to a scene's photographs",
    .usage = "SCENE [options]",
    .summary = "Makes SCENE/soft.ply: ellipsoids of soft opacity that begin at the scene's points and are\n"
               "adjusted by descent on its training photographs. They mend what stereo cannot see. How much of\n"
               "them pictures take is found on photographs that they have not seen, and kept in scene.json;\n"
               "--set soft=0 draws without them. Held-out photographs take no part. An interrupted run goes on\n"
               "when the command is given again.",
    COMMAND_TABLE(refine_options), .inputs_min = 1, .inputs_max = 1, .run = run_refine,
};
