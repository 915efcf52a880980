#include "preprocess/drawing.h"

#include "eval/validation.h"

struct orl_gpu *orl_drawing_device(struct orl_job *job, const struct orl_scene *scene, const char *without)
{
    struct orl_gpu *gpu = NULL;
    if (scene->photo_count - orl_heldout_count(scene) < ORL_VALIDATION_TRAIN_MIN)
        orl_logf(job->log, ORL_LOG_INFO, "%s: needs %d training photographs", without,
                 ORL_VALIDATION_TRAIN_MIN);
    else if (orl_job_gpu(job, &gpu) != ORL_OK)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: no device", without);
    return gpu;
}
