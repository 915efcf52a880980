#include "preprocess/import.h"

#include <stdlib.h>

#include "core/file.h"
#include "core/memory.h"
#include "preprocess/import/import_internal.h"
#include "preprocess/import_densify.h"
#include "scene/cones.h"

static enum orl_result check_params(const struct orl_log *log, const struct orl_import_params *p)
{
    ORL_REQUIRE(log, p->cameras && p->out && *p->out);
    ORL_REQUIRE(log, p->test_every >= 0 && p->max_size >= 0 && p->dark_threshold < 255);
    ORL_REQUIRE(log, p->frames.first >= 0 && p->frames.count >= 0 && p->frames.step >= 1);
    if ((p->silhouettes == ORL_SILHOUETTES_GIVEN) != (p->masks_dir != NULL))
        return orl_fail(log, ORL_ERR_ARGUMENT, "silhouettes are either given (--masks) or found");
    if (p->silhouettes == ORL_SILHOUETTES_BACKGROUND && !p->background)
        return orl_fail(log, ORL_ERR_ARGUMENT, "silhouettes by difference need --background");
    ORL_REQUIRE(log, (p->points == ORL_IMPORT_CLOUD) == (p->points_file != NULL));
    if (p->hull_side && p->mesh)
        return orl_fail(log, ORL_ERR_ARGUMENT, "the mesh is either a file or the hull");
    if (p->hull_side && (p->hull_side < ORL_HULL_SIDE_MIN || p->hull_side > ORL_HULL_SIDE_MAX))
        return orl_fail(log, ORL_ERR_ARGUMENT, "a hull of %d voxels each way: must be from %d to %d",
                        p->hull_side, ORL_HULL_SIDE_MIN, ORL_HULL_SIDE_MAX);
    return ORL_OK;
}

static enum orl_result fill(struct import_job *job)
{
    const struct import_points known = {&job->known.model, false};
    size_t points = 0, triangles = 0;
    ORL_TRY(orl_import_pictures(job));
    // Bad silhouettes for the hull must be reported before the long work.
    ORL_TRY(orl_import_write_mesh(job, &triangles));
    ORL_TRY(orl_import_write_model(job, "sparse", false, &known));
    ORL_TRY(job->params->points == ORL_IMPORT_DENSIFY ? orl_import_densify(job) : orl_import_write_points(job, &points));
    if (job->params->points == ORL_IMPORT_NO_POINTS && !triangles && !job->mask_count)
        orl_logf(job->log, ORL_LOG_WARNING, "the scene has neither points nor a mesh nor silhouettes, and nothing can be "
                 "drawn of it: --points densify makes points, --points FILE takes a cloud");
    ORL_TRY(orl_import_write_manifest(job, points, triangles));
    return orl_new_dir_finish(job->log, &job->new_dir);
}

static void finish(struct import_job *job)
{
    for (size_t i = 0; job->views && i < job->known.model.image_count; i++) {
        free(job->views[i].name);
        orl_import_found_finish(&job->views[i].picture);
        orl_import_found_finish(&job->views[i].mask);
        orl_import_found_finish(&job->views[i].background);
    }
    free(job->views);
    free(job->why_not);
    free(job->targets);
    free(job->first_empty);
    orl_known_cameras_finish(&job->known);
}

// Fills in what the file of cameras states and the user leaves open.
static void resolve(const struct import_job *job, struct orl_import_params *params)
{
    const char *stated = *job->known.points_file ? job->known.points_file : NULL;
    if (params->points != ORL_IMPORT_STATED_POINTS)
        return;
    bool there = stated && orl_path_is_file(stated);
    if (stated && !there)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: the cloud that the cameras' file names is not here", stated);
    params->points = there ? ORL_IMPORT_CLOUD : ORL_IMPORT_NO_POINTS;
    params->points_file = there ? stated : NULL;
}

enum orl_result orl_import(const struct orl_log *log, const struct orl_import_params *params,
                           const struct orl_progress *progress)
{
    struct orl_import_params resolved = *params;
    struct import_job job = {.log = log, .progress = progress, .params = &resolved};
    enum orl_result result = check_params(log, params);
    ORL_THEN(result, orl_known_cameras_read(log, params->cameras, params->pixel_centre, &job.known));
    if (result == ORL_OK)
        resolve(&job, &resolved);
    ORL_THEN(result, orl_import_find_all(&job));
    ORL_THEN(result, orl_new_dir_begin(log, params->out, false, &job.new_dir));
    job.dir = job.new_dir.path;
    ORL_THEN(result, fill(&job));
    orl_new_dir_abort(log, &job.new_dir);
    finish(&job);
    return result;
}
