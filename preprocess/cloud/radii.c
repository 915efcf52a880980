#include "preprocess/cloud/radii.h"

#include <stdlib.h>

#include "core/memory.h"
#include "scene/point_lod.h"
#include "scene/point_radii.h"

// The photographs that are not held out.
struct viewers {
    struct orl_view *views;
    double (*centres)[3];
    size_t count;
};

static void viewers_finish(struct viewers *viewers)
{
    free(viewers->views);
    free(viewers->centres);
}

static enum orl_result find_viewers(struct orl_job *job, struct viewers *viewers)
{
    const struct orl_colmap_model *model;
    enum orl_result result = orl_job_sparse(job, &model);
    if (result != ORL_OK)
        return result;
    viewers->views = orl_array(job->log, model->image_count, sizeof *viewers->views);
    viewers->centres = orl_array(job->log, model->image_count, sizeof *viewers->centres);
    if (!viewers->views || !viewers->centres)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        if (orl_job_find(job, image->name)->test)
            continue;
        viewers->views[viewers->count] = orl_colmap_image_view(model, image);
        orl_pose_centre(&image->cam_from_world, viewers->centres[viewers->count++]);
    }
    return ORL_OK;
}

static struct orl_radii_params radii_params(const struct orl_prepare_params *asked)
{
    struct orl_radii_params params = {ORL_RADII_DEFAULTS};
    if (asked->radius_neighbours)
        params.neighbours = asked->radius_neighbours;
    if (asked->radius_overlap > 0)
        params.overlap = (float)asked->radius_overlap;
    return params;
}

// Values that are not the usual ones; without any it is empty, as it was before there was a choice,
// so that older keys stay valid.
json_t *orl_stage_radii_settings(const struct orl_job *job)
{
    const struct orl_radii_params usual = {ORL_RADII_DEFAULTS};
    const struct orl_radii_params params = radii_params(job->params);
    return json_pack("{s:o*, s:o*}", "neighbours",
                     params.neighbours != usual.neighbours ? json_integer(params.neighbours) : NULL,
                     "overlap",
                     params.overlap != usual.overlap ? json_real((double)params.overlap) : NULL);
}

enum orl_result orl_stage_radii(struct orl_job *job, json_t *record)
{
    const struct orl_radii_params params = radii_params(job->params);
    const struct orl_radii_limits limits = orl_radii_limits_of(&params);
    struct orl_points points = {0};
    struct viewers viewers = {0};
    char *in = orl_job_path(job, ".oriel/fused.ply"), *out = orl_job_path(job, "points.ply");
    enum orl_result result = in && out ? orl_points_read(job->log, in, &points) : ORL_ERR_MEMORY;
    size_t fused = points.count;
    if (result != ORL_OK || (result = find_viewers(job, &viewers)) != ORL_OK ||
        (result = orl_points_set_radii(job->log, job->progress, &params,
                                       (const double (*)[3])viewers.centres, viewers.count,
                                       &points)) != ORL_OK ||
        (result = orl_points_limit_radii(job->log, &limits, viewers.views, viewers.count,
                                         &points)) != ORL_OK)
        goto end;
    result = orl_points_write(job->log, out, &points, false);
    if (result != ORL_OK)
        orl_job_hint_disk(job);
    else
        result = orl_job_remove(job, ORL_LOD_NAME); // levels of the points before these
    json_object_set_new(record, "tool", json_string("FLANN"));
    json_object_set_new(record, "settings", json_pack(
        "{s:i, s:f, s:f, s:f}", "neighbours", params.neighbours, "overlap",
        (double)params.overlap, "largest_px", (double)limits.largest_px, "isolated_px",
        (double)limits.isolated_px));
    json_object_set_new(record, "isolated", json_integer((json_int_t)(fused - points.count)));
    json_object_set_new(record, "points", json_integer((json_int_t)points.count));
end:
    orl_points_finish(&points);
    viewers_finish(&viewers);
    free(in);
    free(out);
    return result;
}
