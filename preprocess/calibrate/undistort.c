// Undistort: pinhole photographs and the sparse model that belongs to them.
#include <math.h>

#include "preprocess/calibrate/companions.h"
#include "preprocess/job/colmap_run.h"

#define WORK ".oriel/undistort.tmp"

// Of COLMAP's output the cameras alone count: Oriel makes the pictures itself, and COLMAP, which finds no photographs
// in an empty folder, makes none.
static enum orl_result run_undistorter(struct orl_job *job)
{
    struct orl_colmap_run run = {.command = "image_undistorter", .step = "undistort"};
    ORL_TRY(orl_job_fresh_dir(job, WORK));
    ORL_TRY(orl_job_fresh_dir(job, WORK "/none"));
    orl_colmap_arg(&run, "--image_path", "%s/" WORK "/none", job->dir);
    orl_colmap_arg(&run, "--input_path", "%s/.oriel/calibrate/model", job->dir);
    orl_colmap_arg(&run, "--output_path", "%s/" WORK, job->dir);
    orl_colmap_arg(&run, "--max_image_size", "%d", orl_prepare_max_size(job->params));
    return orl_job_colmap(job, &run);
}

// COLMAP makes all pictures as small as it is told, but leaves cameras whose distortion is exactly zero
// as large as they were: these get the size that their pictures would have.
static enum orl_result limit_cameras(const struct orl_job *job)
{
    struct orl_colmap_model model = {0};
    const int most = orl_prepare_max_size(job->params);
    const char *dir = ORL_PATH(job->dir, WORK "/sparse");
    bool limited = false;
    enum orl_result result = orl_colmap_read(job->log, dir, &model);
    for (size_t i = 0; result == ORL_OK && i < model.camera_count; i++) {
        struct orl_colmap_camera *camera = &model.cameras[i];
        const struct orl_camera *c = &camera->pinhole;
        double scale = fmin((double)most / c->width, (double)most / c->height);
        if (scale >= 1)
            continue;
        const struct orl_camera small = orl_camera_resized(c, (int)round(scale * c->width),
                                                           (int)round(scale * c->height));
        *camera = orl_colmap_pinhole(camera->id, &small);
        limited = true;
    }
    if (result == ORL_OK && limited)
        result = orl_colmap_write(job->log, dir, &model, NULL);
    orl_colmap_finish(&model);
    return result;
}

static enum orl_result check_cameras(const struct orl_job *job,
                                     const struct orl_colmap_model *model, json_t *record)
{
    int width = 0, height = 0;
    size_t test = 0;
    for (size_t i = 0; i < model->image_count; i++)
        test += orl_job_find(job, model->images[i].name)->test;
    for (size_t i = 0; i < model->camera_count; i++) {
        const struct orl_camera *camera = &model->cameras[i].pinhole;
        if (camera->width > width)
            width = camera->width, height = camera->height;
    }
    if (model->image_count < test + 2)
        return orl_fail(job->log, ORL_ERR_DATA,
                        "of the photographs that are not held out only %zu could be placed; two are needed",
                        model->image_count - test);
    orl_progress_report(job->progress, "undistort", 1, 1, NULL);
    json_object_set_new(record, "largest", json_pack("[i, i]", width, height));
    return ORL_OK;
}

// Moves what was made of some photographs to SCENE/`name`; of none: what was there goes.
static enum orl_result replace_some(const struct orl_job *job, size_t count, const char *temp,
                                    const char *name)
{
    return count ? orl_job_replace(job, temp, name) : orl_job_remove(job, name);
}

enum orl_result orl_stage_undistort(struct orl_job *job, json_t *record)
{
    const struct orl_colmap_model *model;
    size_t photos, linear = 0, masks = 0;
    ORL_TRY(orl_job_find_colmap(job));
    ORL_TRY(run_undistorter(job));
    ORL_TRY(limit_cameras(job));
    ORL_TRY(orl_job_set_sparse(job, WORK "/sparse", &model));
    ORL_TRY(check_cameras(job, model, record));
    ORL_TRY(orl_undistort_companions(job, ORL_COMPANION_PHOTO, model, WORK "/images", &photos));
    ORL_TRY(orl_undistort_companions(job, ORL_COMPANION_LINEAR, model, WORK "/linear", &linear));
    ORL_TRY(orl_undistort_companions(job, ORL_COMPANION_MASK, model, WORK "/masks", &masks));
    ORL_TRY(orl_job_replace(job, WORK "/sparse", "sparse"));
    ORL_TRY(replace_some(job, linear, WORK "/linear", "images_linear"));
    ORL_TRY(replace_some(job, masks, WORK "/masks", "masks"));
    ORL_TRY(orl_job_replace(job, WORK "/images", "images"));
    if (linear)
        json_object_set_new(record, "linear_scale", json_real(job->linear_scale));
    if (masks)
        json_object_set_new(record, "masks", json_integer((json_int_t)masks));
    json_object_set_new(record, "tool", json_sprintf("COLMAP %s", job->colmap_version));
    return orl_job_remove(job, WORK);
}
