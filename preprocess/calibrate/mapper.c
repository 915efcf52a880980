#include "preprocess/calibrate/mapper.h"

#include "preprocess/calibrate/match.h"
#include "preprocess/job/colmap_run.h"

enum {
    INCREMENTAL_MAX = 400, // photographs up to which auto maps incrementally
    LEAF_MAX = 200,        // photographs that the hierarchical mapper maps at a time
};

enum orl_result orl_mapper_choose(const struct orl_job *job, enum orl_mapper *mapper)
{
    *mapper = job->params->mapper;
    if (*mapper == ORL_MAPPER_GLOBAL && !job->colmap_global)
        return orl_fail(job->log, ORL_ERR_EXTERNAL,
                        "--mapper global: COLMAP %s has no global_mapper; version 4 has",
                        job->colmap_version);
    if (*mapper == ORL_MAPPER_AUTO)
        *mapper = job->source_count <= INCREMENTAL_MAX ? ORL_MAPPER_INCREMENTAL
                  : job->colmap_global                 ? ORL_MAPPER_GLOBAL
                                                       : ORL_MAPPER_HIERARCHICAL;
    return ORL_OK;
}

static void incremental_settings(const struct orl_mapper_run *run, struct orl_colmap_run *colmap)
{
    // A later, larger model must not be thrown away for being under ten photographs.
    orl_colmap_arg(colmap, "--Mapper.min_model_size", "3");
    if (run->straight)
        orl_colmap_arg(colmap, "--Mapper.ba_refine_extra_params", "0");
    if (run->loose) {
        orl_colmap_arg(colmap, "--Mapper.init_min_tri_angle", "6");
        orl_colmap_arg(colmap, "--Mapper.init_min_num_inliers", "40");
        orl_colmap_arg(colmap, "--Mapper.abs_pose_min_num_inliers", "15");
        orl_colmap_arg(colmap, "--Mapper.abs_pose_min_inlier_ratio", "0.15");
    }
}

// The database, the photographs and the seed, which all mappers take.
static void common_settings(const struct orl_job *job, struct orl_colmap_run *colmap)
{
    orl_colmap_arg(colmap, "--database_path", "%s/" ORL_CALIBRATE_DATABASE, job->dir);
    orl_colmap_arg(colmap, "--image_path", "%s/.oriel/photos", job->dir);
    orl_colmap_arg(colmap, "--random_seed", "%u", job->params->seed);
}

enum orl_result orl_mapper_run(struct orl_job *job, const struct orl_mapper_run *run)
{
    static const char *const commands[] = {
        [ORL_MAPPER_INCREMENTAL] = "mapper", [ORL_MAPPER_HIERARCHICAL] = "hierarchical_mapper",
        [ORL_MAPPER_GLOBAL] = "global_mapper"};
    enum orl_mapper mapper = run->from || run->loose ? ORL_MAPPER_INCREMENTAL : run->mapper;
    // COLMAP's mapper fails when no pair of photographs can start a model. That is for calibrate to
    // judge, not an error yet. The others have a substitute, whatever they fail from.
    struct orl_colmap_run colmap = {
        .command = commands[mapper], .step = "mapping", .share = (double)job->source_count,
        .total = (double)job->source_count, .tolerated = {""}};
    if (mapper == ORL_MAPPER_INCREMENTAL) { // what COLMAP 3 and 4 say of photographs without a model
        colmap.tolerated[0] = "failed to create sparse model";
        colmap.tolerated[1] = "Failed to create any sparse model";
    }
    common_settings(job, &colmap);
    orl_colmap_arg(&colmap, "--output_path", "%s", run->out);
    if (mapper == ORL_MAPPER_GLOBAL && run->straight)
        orl_colmap_arg(&colmap, "--GlobalMapper.ba_refine_extra_params", "0");
    if (mapper != ORL_MAPPER_GLOBAL)
        incremental_settings(run, &colmap);
    // COLMAP 4's way to place a photograph that sees too few points ends by a signal in 4.2.1.
    if (mapper != ORL_MAPPER_GLOBAL && job->colmap_features)
        orl_colmap_arg(&colmap, "--Mapper.structure_less_registration_fallback", "0");
    if (mapper == ORL_MAPPER_HIERARCHICAL)
        orl_colmap_arg(&colmap, "--leaf_max_num_images", "%d", LEAF_MAX);
    if (run->from)
        orl_colmap_arg(&colmap, "--input_path", "%s", run->from);
    return orl_job_colmap(job, &colmap);
}

enum orl_result orl_mapper_refine(struct orl_job *job, const char *from, const char *out,
                                  bool straight)
{
    struct orl_colmap_run triangulator = {.command = "point_triangulator", .step = "mapping"};
    struct orl_colmap_run adjuster = {.command = "bundle_adjuster", .step = "mapping"};
    common_settings(job, &triangulator);
    orl_colmap_arg(&triangulator, "--input_path", "%s", from);
    orl_colmap_arg(&triangulator, "--output_path", "%s", out);
    orl_colmap_arg(&adjuster, "--input_path", "%s", out);
    orl_colmap_arg(&adjuster, "--output_path", "%s", out);
    if (straight)
        orl_colmap_arg(&adjuster, "--BundleAdjustment.refine_extra_params", "0");
    ORL_TRY(orl_job_colmap(job, &triangulator));
    return orl_job_colmap(job, &adjuster);
}
