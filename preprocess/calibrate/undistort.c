#include "preprocess/calibrate/undistort.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "preprocess/calibrate/companions.h"
#include "preprocess/job/colmap_run.h"

#define WORK ".oriel/undistort.tmp"
#define MASK_WORK ".oriel/masks.tmp"

static enum orl_result run_undistorter(struct orl_job *job, const char *from, const char *to,
                                       const char *step)
{
    struct orl_colmap_args args = {0};
    char *photos = orl_job_path(job, "%s", from), *out = orl_job_path(job, "%s", to);
    char *model = orl_job_path(job, ".oriel/calibrate/model");
    enum orl_result result = photos && out && model ? orl_job_fresh_dir(job, to) : ORL_ERR_MEMORY;
    if (result != ORL_OK)
        goto end;
    orl_colmap_arg(&args, "--image_path", "%s", photos);
    orl_colmap_arg(&args, "--input_path", "%s", model);
    orl_colmap_arg(&args, "--output_path", "%s", out);
    orl_colmap_arg(&args, "--max_image_size", "%d", orl_prepare_max_size(job->params));
    result = orl_job_colmap(job, &(struct orl_colmap_run){
        .command = "image_undistorter", .step = step, .share = 1, .total = 1}, &args);
end:
    free(photos);
    free(out);
    free(model);
    return result;
}

// COLMAP does not notice when a picture cannot be written, so each is read again.
static enum orl_result check_photo(const struct orl_job *job,
                                   const struct orl_colmap_model *model,
                                   const struct orl_colmap_image *image)
{
    const struct orl_camera *camera =
        &orl_colmap_camera_by_id(model, image->camera_id)->pinhole;
    struct orl_image picture = {0};
    char *path = orl_job_path(job, WORK "/images/%s", image->name);
    enum orl_result result = path ? orl_picture_read(job->log, path, 1, &picture)
                                  : ORL_ERR_MEMORY;
    if (result == ORL_OK && (picture.width != camera->width || picture.height != camera->height))
        result = orl_fail(job->log, ORL_ERR_EXTERNAL, "%s: %dx%d pixels, but COLMAP's camera has "
                          "%dx%d", path, picture.width, picture.height, camera->width,
                          camera->height);
    else if (result != ORL_OK && result != ORL_ERR_MEMORY)
        result = orl_fail(job->log, ORL_ERR_IO, "%s: COLMAP did not write it whole", path);
    orl_image_finish(&picture);
    free(path);
    return result;
}

static enum orl_result check_output(const struct orl_job *job,
                                    const struct orl_colmap_model *model, json_t *record)
{
    int width = 0, height = 0;
    size_t test = 0;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++) {
        result = check_photo(job, model, &model->images[i]);
        test += orl_job_find(job, model->images[i].name)->test;
    }
    for (size_t i = 0; i < model->camera_count; i++) {
        const struct orl_camera *camera = &model->cameras[i].pinhole;
        if (camera->width > width)
            width = camera->width, height = camera->height;
    }
    if (result == ORL_OK && model->image_count < test + 2)
        result = orl_fail(job->log, ORL_ERR_DATA,
                          "of the photographs that are not held out only %zu could be placed; "
                          "two are needed", model->image_count - test);
    orl_progress_report(job->progress, "undistort", 1, 1, NULL);
    if (result == ORL_OK)
        json_object_set_new(record, "largest", json_pack("[i, i]", width, height));
    else
        orl_job_hint_disk(job);
    return result;
}

// --- masks: undistorted as photographs are, then cut to black and white ---

static enum orl_result convert_mask(const struct orl_job *job, const char *name)
{
    struct orl_image mask = {0};
    char *from = orl_job_path(job, MASK_WORK "/images/%s", name);
    char *to = orl_job_path(job, MASK_WORK "/masks/%s.png", name);
    enum orl_result result = from && to ? orl_picture_read(job->log, from, 1, &mask)
                                        : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        // JPEG and resampling leave greys.
        size_t count = orl_image_bytes(&mask);
        for (size_t i = 0; i < count; i++)
            mask.u8[i] = mask.u8[i] >= 128 ? 255 : 0;
        result = orl_png_write(job->log, to, &mask);
    }
    orl_image_finish(&mask);
    free(from);
    free(to);
    return result;
}

// Photographs without a mask get none: they are used whole. COLMAP wants a picture
// for each, so the photograph stands in for the mask that is not there.
static enum orl_result link_mask_inputs(const struct orl_job *job)
{
    enum orl_result result = orl_job_fresh_dir(job, ".oriel/masks-in.tmp");
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++) {
        const struct orl_source *source = &job->sources[i];
        char *path = orl_job_path(job, ".oriel/masks-in.tmp/%s", source->name);
        result = path ? orl_job_link(job, source->mask ? source->mask : source->path, path)
                      : ORL_ERR_MEMORY;
        free(path);
    }
    return result;
}

static enum orl_result undistort_masks(struct orl_job *job)
{
    enum orl_result result;
    if ((result = link_mask_inputs(job)) != ORL_OK ||
        (result = run_undistorter(job, ".oriel/masks-in.tmp", MASK_WORK, "masks")) != ORL_OK ||
        (result = orl_job_fresh_dir(job, MASK_WORK "/masks")) != ORL_OK)
        return result;
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++) {
        const char *name = job->sources[i].name;
        char inside[4096];
        snprintf(inside, sizeof inside, MASK_WORK "/images/%s", name);
        if (job->sources[i].mask && orl_job_has(job, inside))
            result = convert_mask(job, name);
    }
    if (result == ORL_OK)
        result = orl_job_replace(job, MASK_WORK "/masks", ".oriel/masks");
    orl_progress_report(job->progress, "masks", 1, 1, NULL);
    return result;
}

enum orl_result orl_stage_undistort(struct orl_job *job, json_t *record)
{
    static const char *const temporary[] = {WORK, MASK_WORK, ".oriel/masks-in.tmp"};
    const struct orl_colmap_model *model;
    size_t linear = 0;
    enum orl_result result;
    if ((result = orl_job_find_colmap(job)) != ORL_OK ||
        (result = run_undistorter(job, ".oriel/photos", WORK, "undistort")) != ORL_OK ||
        (result = orl_job_set_sparse(job, WORK "/sparse", &model)) != ORL_OK ||
        (result = check_output(job, model, record)) != ORL_OK ||
        (result = orl_undistort_linear(job, model, WORK "/linear", &linear)) != ORL_OK ||
        (job->params->masks_dir && (result = undistort_masks(job)) != ORL_OK) ||
        (result = orl_job_replace(job, WORK "/sparse", "sparse")) != ORL_OK ||
        (result = linear ? orl_job_replace(job, WORK "/linear", "images_linear")
                         : orl_job_remove(job, "images_linear")) != ORL_OK ||
        (result = orl_job_replace(job, WORK "/images", "images")) != ORL_OK)
        return result;
    if (linear)
        json_object_set_new(record, "linear_scale", json_real(job->linear_scale));
    json_object_set_new(record, "tool", json_sprintf("COLMAP %s", job->colmap_version));
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(temporary); i++)
        result = orl_job_remove(job, temporary[i]);
    return result;
}
