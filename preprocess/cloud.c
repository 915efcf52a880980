// Radii: the fused cloud becomes points.ply, with a radius and a normal for each.
#include <stdlib.h>

#include "core/memory.h"
#include "preprocess/job.h"
#include "scene/radii.h"

// Camera centres of the photographs that are not held out.
static enum orl_result find_viewers(const struct orl_job *job, double (**viewers)[3],
                                    size_t *count)
{
    struct orl_colmap_model model = {0};
    char *sparse = orl_job_path(job, "sparse");
    enum orl_result result = sparse ? orl_colmap_read(job->log, sparse, &model) : ORL_ERR_MEMORY;
    *viewers = NULL;
    *count = 0;
    if (result == ORL_OK && !(*viewers = orl_array(job->log, model.image_count, sizeof **viewers)))
        result = ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < model.image_count; i++) {
        const struct orl_source *source = orl_job_find(job, model.images[i].name);
        if (source && !source->test)
            orl_pose_centre(&model.images[i].cam_from_world, (*viewers)[(*count)++]);
    }
    orl_colmap_finish(&model);
    free(sparse);
    return result;
}

enum orl_result orl_stage_radii(struct orl_job *job, json_t *record)
{
    const struct orl_radii_params params = {ORL_RADII_DEFAULTS};
    struct orl_points points = {0};
    double (*viewers)[3] = NULL;
    size_t viewer_count = 0;
    char *in = orl_job_path(job, ".oriel/fused.ply"), *out = orl_job_path(job, "points.ply");
    enum orl_result result = in && out ? orl_points_read(job->log, in, &points) : ORL_ERR_MEMORY;
    if (result != ORL_OK || (result = find_viewers(job, &viewers, &viewer_count)) != ORL_OK)
        goto end;
    result = orl_points_set_radii(job->log, job->progress, &params,
                                  (const double (*)[3])viewers, viewer_count, &points);
    if (result != ORL_OK)
        goto end;
    result = orl_points_write(job->log, out, &points);
    if (result != ORL_OK)
        orl_job_hint_disk(job);
    json_object_set_new(record, "tool", json_string("FLANN"));
    json_object_set_new(record, "settings",
                        json_pack("{s:i, s:f}", "neighbours", params.neighbours, "overlap",
                                  (double)params.overlap));
    json_object_set_new(record, "points", json_integer((json_int_t)points.count));
end:
    orl_points_finish(&points);
    free(viewers);
    free(in);
    free(out);
    return result;
}
