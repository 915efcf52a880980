#include "preprocess/calibrate/companions.h"

#include <stdlib.h>

#include "io/linear.h"
#include "io/remap.h"
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

enum orl_result orl_undistort_linear(struct orl_job *job,
                                     const struct orl_colmap_model *undistorted, const char *out,
                                     size_t *written)
{
    size_t count = 0;
    *written = 0;
    for (size_t i = 0; i < undistorted->image_count; i++)
        count += orl_job_find(job, undistorted->images[i].name)->deep;
    if (!count)
        return ORL_OK;
    enum orl_result result = orl_job_fresh_dir(job, out);
    for (size_t i = 0; result == ORL_OK && i < undistorted->image_count; i++) {
        const struct orl_colmap_image *image = &undistorted->images[i];
        if (!orl_job_find(job, image->name)->deep)
            continue;
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        orl_progress_report(job->progress, "linear", (double)(*written)++, (double)count,
                            image->name);
        result = write_linear(job, undistorted, image, out);
    }
    if (result == ORL_OK)
        orl_progress_report(job->progress, "linear", 1, 1, NULL);
    return result;
}
