// Ground: the plane below the cameras.
#include "preprocess/job/job.h"
#include "scene/manifest.h"

enum orl_result orl_stage_ground(struct orl_job *job, json_t *record)
{
    struct orl_scene *scene = NULL;
    enum orl_result result = orl_job_open_scene(job, &scene);
    if (result == ORL_OK &&
        json_object_set_new(record, "ground", orl_manifest_ground(&scene->ground)) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the ground");
    orl_scene_destroy(&scene);
    return result;
}
