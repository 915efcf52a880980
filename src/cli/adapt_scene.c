#include "cli/adapt_scene.h"

#include <stdio.h>

enum orl_result adapt_scene(const struct terminal *terminal, const struct arg_common *common,
                            const char *dir, size_t views, int size_divide, double budget_s)
{
    const struct orl_log *log = &terminal->log;
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    struct orl_adapt adapt = {0};
    const struct orl_adapt_params params = {.views = views, .size_divide = size_divide,
                                            .budget_s = budget_s,
                                            .progress = &terminal->progress};
    enum orl_result result = orl_scene_open(log, dir, &scene);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    if (result == ORL_OK)
        result = orl_adapt_run(gpu, scene, &params, &adapt);
    for (size_t i = 0; result == ORL_OK && i < adapt.row_count; i++)
        printf("%-14s %7.2f dB %7.4f%s\n", adapt.rows[i].method->name, adapt.rows[i].psnr_db,
               adapt.rows[i].ssim, i == adapt.chosen ? "  chosen" : "");
    if (result == ORL_OK)
        printf("%-14s %7.2f dB %7.4f%s\n", "adapted", adapt.tuned_db, adapt.tuned_ssim,
               adapt.complete ? "" : "  (the time ran out)");
    orl_gpu_destroy(&gpu);
    orl_scene_destroy(&scene);
    return result;
}
