#include "preprocess/calibrate/companions.h"

#include "io/exr.h"
#include "scene/colmap.h"
#include "preprocess/photos/develop.h"

// To the pixels that the photograph has in `model`.
static enum orl_result undistort(struct orl_job *job, const struct orl_colmap_model *model,
                                 const struct orl_colmap_image *image,
                                 const struct orl_image *picture, struct orl_image *out)
{
    const struct orl_colmap_model *from;
    ORL_TRY(orl_job_calibrated(job, &from));
    const struct orl_colmap_image *was = orl_colmap_image_by_name(from, image->name);
    if (!was)
        return orl_fail(job->log, ORL_ERR_DATA, "%s: not in the calibrated model", image->name);
    return orl_undistort(job->log, orl_colmap_camera_by_id(from, was->camera_id),
                         &orl_colmap_camera_by_id(model, image->camera_id)->pinhole, picture, out);
}

static enum orl_result read_photo(const struct orl_job *job, const struct orl_source *source,
                                  struct orl_image *image)
{
    return orl_picture_read(job->log, source->path, 3, image);
}

static enum orl_result write_photo(const struct orl_log *log, const char *path,
                                   const struct orl_image *image)
{
    enum { QUALITY = 97 };
    return orl_picture_is_png(path) ? orl_png_write(log, path, image)
                                    : orl_jpeg_write(log, path, image, QUALITY, NULL);
}

static enum orl_result read_mask(const struct orl_job *job, const struct orl_source *source,
                                 struct orl_image *image)
{
    return orl_picture_read(job->log, source->mask, 1, image);
}

static enum orl_result write_mask(const struct orl_log *log, const char *path,
                                  const struct orl_image *image)
{
    size_t count = orl_image_bytes(image);
    for (size_t i = 0; i < count; i++) // resampling leaves greys
        image->u8[i] = image->u8[i] >= 128 ? 255 : 0;
    return orl_png_write(log, path, image);
}

static const struct {
    const char *step;   // for the progress
    const char *ending; // put after a photograph's name
    enum orl_result (*read)(const struct orl_job *job, const struct orl_source *source,
                            struct orl_image *image);
    enum orl_result (*write)(const struct orl_log *log, const char *path,
                             const struct orl_image *image);
} companions[] = {
    [ORL_COMPANION_PHOTO] = {"photographs", "", read_photo, write_photo},
    [ORL_COMPANION_LINEAR] = {"linear", ".exr", orl_develop_read, orl_linear_write},
    [ORL_COMPANION_MASK] = {"masks", ".png", read_mask, write_mask},
};

static bool has(const struct orl_source *source, enum orl_companion which)
{
    return which == ORL_COMPANION_LINEAR ? source->deep
                                         : which == ORL_COMPANION_PHOTO || source->mask;
}

static enum orl_result write_one(struct orl_job *job, enum orl_companion which,
                                 const struct orl_colmap_model *model,
                                 const struct orl_colmap_image *image, const char *out)
{
    struct orl_image given = {0}, undistorted = {0};
    const char *path = ORL_PATH(job->dir, "%s/%s%s", out, image->name, companions[which].ending);
    enum orl_result result = companions[which].read(job, orl_job_find(job, image->name), &given);
    ORL_THEN(result, undistort(job, model, image, &given, &undistorted));
    ORL_THEN(result, companions[which].write(job->log, path, &undistorted));
    orl_image_finish(&given);
    orl_image_finish(&undistorted);
    return result;
}

enum orl_result orl_undistort_companions(struct orl_job *job, enum orl_companion which,
                                         const struct orl_colmap_model *model, const char *out,
                                         size_t *written)
{
    const char *step = companions[which].step;
    size_t count = 0;
    *written = 0;
    for (size_t i = 0; i < model->image_count; i++)
        count += has(orl_job_find(job, model->images[i].name), which);
    if (!count)
        return ORL_OK;
    ORL_TRY(orl_job_fresh_dir(job, out));
    for (size_t i = 0; i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        if (!has(orl_job_find(job, image->name), which))
            continue;
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        orl_progress_report(job->progress, step, (double)(*written)++, (double)count, image->name);
        ORL_TRY(write_one(job, which, model, image, out));
    }
    orl_progress_report(job->progress, step, 1, 1, NULL);
    return ORL_OK;
}
