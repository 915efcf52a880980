// Occluders: what photographs show before the scene and has no points (eval/occluder_masks.h).
#include <stdlib.h>

#include "core/file.h"
#include "core/memory.h"
#include "eval/occluder_masks.h"
#include "io/picture.h"
#include "preprocess/drawing.h"
#include "preprocess/scene_json.h"

// The folder is made for the first mask, so that scenes without any have none.
static enum orl_result write_masks(struct orl_job *job, const struct orl_scene *scene,
                                   const struct orl_image *masks, const double *shares,
                                   json_t *occluded)
{
    size_t written = 0;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        if (!(shares[i] > 0))
            continue;
        if (written++ == 0)
            result = orl_job_fresh_dir(job, "occluders");
        const struct orl_file_path path = orl_scene_file(scene, i, ORL_FILE_OCCLUDERS);
        ORL_THEN(result, orl_file_make_folder(job->log, path.text));
        ORL_THEN(result, orl_png_write(job->log, path.text, &masks[i]));
        if (result == ORL_OK && json_object_set_new(occluded, scene->photos[i].name,
                                                    json_real(shares[i])) != 0)
            result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the occluders");
    }
    if (result == ORL_OK && written == 0)
        result = orl_job_remove(job, "occluders");
    orl_logf(job->log, ORL_LOG_INFO, "occluders: %zu photographs show some", written);
    return result;
}

// Of renderings in which nothing is taken for an occluder.
static enum orl_result find(struct orl_job *job, struct orl_gpu *gpu, struct orl_scene *scene,
                            json_t *occluded)
{
    for (size_t i = 0; i < scene->photo_count; i++)
        scene->photos[i].occluded = 0;
    struct orl_image *masks = orl_array(job->log, scene->photo_count, sizeof *masks);
    double *shares = orl_array(job->log, scene->photo_count, sizeof *shares);
    enum orl_result result = masks && shares ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_occluders_find(gpu, scene, job->progress, masks, shares));
    ORL_THEN(result, write_masks(job, scene, masks, shares, occluded));
    for (size_t i = 0; masks && i < scene->photo_count; i++)
        orl_image_finish(&masks[i]);
    free(masks);
    free(shares);
    return result;
}

enum orl_result orl_stage_occluders(struct orl_job *job, json_t *record)
{
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    json_t *occluded = json_object();
    enum orl_result result = json_object_set_new(record, "occluded", occluded) == 0
                                 ? orl_scene_json_open(job, &scene)
                                 : orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the occluders");
    if (result == ORL_OK)
        gpu = orl_drawing_device(job, scene, "occluders: none are looked for");
    if (gpu)
        result = find(job, gpu, scene, occluded);
    else if (result == ORL_OK)
        result = orl_job_remove(job, "occluders");
    orl_scene_destroy(&scene);
    return result;
}
