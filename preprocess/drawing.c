#include "preprocess/drawing.h"

#include "eval/validation.h"

void orl_drawing_begin(const struct orl_job *job, const struct orl_scene *scene,
                       const char *without, struct orl_drawing *drawing)
{
    const struct orl_gpu_params params = {.shader_dir = job->params->shader_dir};
    *drawing = (struct orl_drawing){0};
    if (scene->photo_count - orl_heldout_count(scene) < ORL_VALIDATION_TRAIN_MIN)
        orl_logf(job->log, ORL_LOG_INFO, "%s: needs %d training photographs", without,
                 ORL_VALIDATION_TRAIN_MIN);
    else if (job->params->gpu)
        drawing->gpu = job->params->gpu;
    else if (orl_gpu_create(job->log, &params, &drawing->own) != ORL_OK)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: no device", without);
    else
        drawing->gpu = drawing->own;
}

void orl_drawing_end(struct orl_drawing *drawing)
{
    orl_gpu_destroy(&drawing->own);
}
