// Radii: a radius and a normal for each point of the fused cloud.
#include <stdlib.h>

#include "core/memory.h"
#include "preprocess/job/job.h"
#include "scene/manifest.h"
#include "scene/nearest_points.h"
#include "scene/point_lod.h"
#include "scene/point_stream.h"

// The photographs that are not held out.
struct viewers {
    struct orl_view *views;
    size_t count;
};

static enum orl_result find_viewers(struct orl_job *job, struct viewers *viewers)
{
    const struct orl_colmap_model *model;
    ORL_TRY(orl_job_sparse(job, &model));
    viewers->views = orl_array(job->log, model->image_count, sizeof *viewers->views);
    ORL_TRY_MEMORY(viewers->views);
    for (size_t i = 0; i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        if (!orl_job_find(job, image->name)->test)
            viewers->views[viewers->count++] = orl_colmap_image_view(model, image);
    }
    return ORL_OK;
}

static struct orl_radii_params radii_params(const struct orl_prepare_params *asked)
{
    struct orl_radii_params params = {ORL_RADII_DEFAULTS, .dense = true};
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

// In memory: points.ply.
static enum orl_result write_whole(struct orl_job *job, const struct orl_radii_params *params,
                                   const struct viewers *viewers, const char *in, size_t *left)
{
    struct orl_points points = {0};
    enum orl_result result = orl_points_read(job->log, in, NULL, &points);
    ORL_THEN(result, orl_points_find_radii(job->log, job->progress, params, viewers->views, viewers->count,
                                           &points));
    ORL_THEN(result, orl_points_write(job->log, ORL_PATH(job->dir, "points.ply"), &points, false, NULL));
    if (result == ORL_OK)
        result = orl_job_remove(job, ORL_LOD_NAME); // levels of the points before these
    *left = points.count;
    orl_points_finish(&points);
    return result;
}

// In parts: points.lod.
static enum orl_result write_levels(struct orl_job *job, const struct orl_radii_params *params,
                                    const struct viewers *viewers, const char *in, size_t *left)
{
    const struct orl_lod_params how = {.max_bytes = job->params->max_ram_bytes, .radii = *params,
                                       .views = viewers->views, .view_count = viewers->count};
    struct orl_lod *lod = NULL;
    const char *out = ORL_PATH(job->dir, ORL_LOD_NAME);
    enum orl_result result = orl_lod_write(job->log, job->progress, &how, in, out);
    ORL_THEN(result, orl_lod_open(job->log, out, &lod));
    if (result == ORL_OK)
        result = orl_job_remove(job, "points.ply"); // of a cloud that was smaller
    *left = lod ? (size_t)lod->points : 0;
    orl_lod_close(&lod);
    return result;
}

enum orl_result orl_stage_radii(struct orl_job *job, json_t *record)
{
    const struct orl_radii_params params = radii_params(job->params);
    const struct orl_radii_limits limits = orl_radii_limits_of(&params);
    uint64_t fused = 0, most = orl_lod_most_in_memory(job->params->max_ram_bytes);
    size_t left = 0;
    struct viewers viewers = {0};
    struct orl_point_stream *stream = NULL;
    const char *in = ORL_PATH(job->dir, ".oriel/fused.ply");
    if (most > ORL_SEARCH_POINTS_MAX)
        most = ORL_SEARCH_POINTS_MAX; // whatever memory there is
    enum orl_result result = orl_point_stream_open(job->log, in, &stream, &fused);
    orl_point_stream_close(&stream);
    ORL_THEN(result, find_viewers(job, &viewers));
    if (result == ORL_OK && fused > most)
        orl_logf(job->log, ORL_LOG_INFO, "radii: %llu points are more than the %llu that are "
                 "held in memory; dividing them on disk", (unsigned long long)fused,
                 (unsigned long long)most);
    ORL_THEN(result, fused > most ? write_levels(job, &params, &viewers, in, &left)
                                  : write_whole(job, &params, &viewers, in, &left));
    ORL_THEN(result, orl_job_remove(job, ORL_SOFT_NAME)); // soft splats of the points before these
    ORL_THEN(result, orl_job_remove(job, ORL_REFINE_STATE_NAME));
    json_object_set_new(record, "tool", json_string("FLANN"));
    json_object_set_new(record, "settings", json_pack(
        "{s:i, s:f, s:f, s:f}", "neighbours", params.neighbours, "overlap",
        (double)params.overlap, "largest_px", (double)limits.largest_px, "isolated_px",
        (double)limits.isolated_px));
    json_object_set_new(record, "isolated", json_integer((json_int_t)(fused - left)));
    json_object_set_new(record, "points", json_integer((json_int_t)left));
    free(viewers.views);
    return result;
}
