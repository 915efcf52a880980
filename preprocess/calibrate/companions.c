#include "preprocess/calibrate/companions.h"

#include <stdlib.h>

#include "scene/linear.h"
#include "scene/remap.h"
#include "preprocess/photos/develop.h"

// To the pixels that the photograph has in `model`.
static enum orl_result undistort(struct orl_job *job, const struct orl_colmap_model *model,
                                 const struct orl_colmap_image *image,
                                 const struct orl_image *picture, struct orl_image *out)
{
    const struct orl_colmap_model *from;
    enum orl_result result = orl_job_calibrated(job, &from);
    if (result != ORL_OK)
        return result;
    const struct orl_colmap_image *was = orl_colmap_image_by_name(from, image->name);
    if (!was)
        return orl_fail(job->log, ORL_ERR_DATA, "%s: not in the calibrated model", image->name);
    return orl_undistort(job->log, orl_colmap_camera_by_id(from, was->camera_id),
                         &orl_colmap_camera_by_id(model, image->camera_id)->pinhole, picture, out);
}

static enum orl_result write_photo(struct orl_job *job, const struct orl_colmap_model *model,
                                   const struct orl_colmap_image *image, const char *out)
{
    enum { QUALITY = 97 };
    struct orl_image given = {0}, undistorted = {0};
    char *path = orl_job_path(job, "%s/%s", out, image->name);
    enum orl_result result =
        path ? orl_picture_read(job->log, orl_job_find(job, image->name)->path, 3, &given)
             : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = undistort(job, model, image, &given, &undistorted);
    if (result == ORL_OK)
        result = orl_picture_is_png(image->name)
                     ? orl_png_write(job->log, path, &undistorted)
                     : orl_jpeg_write(job->log, path, &undistorted, QUALITY, NULL);
    orl_image_finish(&given);
    orl_image_finish(&undistorted);
    free(path);
    return result;
}

static enum orl_result write_linear(struct orl_job *job, const struct orl_colmap_model *model,
                                    const struct orl_colmap_image *image, const char *out)
{
    struct orl_image given = {0}, undistorted = {0};
    char *path = orl_job_path(job, "%s/%s.exr", out, image->name);
    enum orl_result result =
        path ? orl_develop_read(job, orl_job_find(job, image->name), &given) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = undistort(job, model, image, &given, &undistorted);
    if (result == ORL_OK)
        result = orl_linear_write(job->log, path, &undistorted);
    orl_image_finish(&given);
    orl_image_finish(&undistorted);
    free(path);
    return result;
}

static enum orl_result write_mask(struct orl_job *job, const struct orl_colmap_model *model,
                                  const struct orl_colmap_image *image, const char *out)
{
    struct orl_image given = {0}, undistorted = {0};
    char *path = orl_job_path(job, "%s/%s.png", out, image->name);
    enum orl_result result =
        path ? orl_picture_read(job->log, orl_job_find(job, image->name)->mask, 1, &given)
             : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = undistort(job, model, image, &given, &undistorted);
    // Resampling leaves greys.
    size_t count = result == ORL_OK ? orl_image_bytes(&undistorted) : 0;
    for (size_t i = 0; i < count; i++)
        undistorted.u8[i] = undistorted.u8[i] >= 128 ? 255 : 0;
    if (result == ORL_OK)
        result = orl_png_write(job->log, path, &undistorted);
    orl_image_finish(&given);
    orl_image_finish(&undistorted);
    free(path);
    return result;
}

// What goes with some of the photographs.
struct companion {
    const char *step; // for the progress
    bool (*has)(const struct orl_source *source);
    enum orl_result (*write)(struct orl_job *job, const struct orl_colmap_model *model,
                             const struct orl_colmap_image *image, const char *out);
};

static enum orl_result write_all(struct orl_job *job, const struct companion *companion,
                                 const struct orl_colmap_model *model, const char *out,
                                 size_t *written)
{
    size_t count = 0;
    *written = 0;
    for (size_t i = 0; i < model->image_count; i++)
        count += companion->has(orl_job_find(job, model->images[i].name));
    if (!count)
        return ORL_OK;
    enum orl_result result = orl_job_fresh_dir(job, out);
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        if (!companion->has(orl_job_find(job, image->name)))
            continue;
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        orl_progress_report(job->progress, companion->step, (double)(*written)++, (double)count,
                            image->name);
        result = companion->write(job, model, image, out);
    }
    if (result == ORL_OK)
        orl_progress_report(job->progress, companion->step, 1, 1, NULL);
    return result;
}

static bool is_any(const struct orl_source *source)
{
    return source != NULL;
}

static bool is_deep(const struct orl_source *source)
{
    return source->deep;
}

static bool is_masked(const struct orl_source *source)
{
    return source->mask != NULL;
}

enum orl_result orl_undistort_photos(struct orl_job *job,
                                     const struct orl_colmap_model *undistorted, const char *out)
{
    static const struct companion photos = {"photographs", is_any, write_photo};
    size_t written;
    return write_all(job, &photos, undistorted, out, &written);
}

enum orl_result orl_undistort_linear(struct orl_job *job,
                                     const struct orl_colmap_model *undistorted, const char *out,
                                     size_t *written)
{
    static const struct companion linear = {"linear", is_deep, write_linear};
    return write_all(job, &linear, undistorted, out, written);
}

enum orl_result orl_undistort_masks(struct orl_job *job,
                                    const struct orl_colmap_model *undistorted, const char *out,
                                    size_t *written)
{
    static const struct companion masks = {"masks", is_masked, write_mask};
    return write_all(job, &masks, undistorted, out, written);
}
