#include "preprocess/cloud/fuse_photographs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/file.h"
#include "core/memory.h"
#include "preprocess/cloud/fuse_memory.h"
#include "preprocess/job/colmap_run.h"
#include "scene/point_radii.h"
#include "scene/thin.h"

// Fraction of depth by which a photograph must see past a point to call the point an outlier.
static const float STRAY_TOLERANCE = 0.01f;

static const double GIB = 1 << 30, CACHE_LEAST_GIB = 1.0 / 256;

// Size of COLMAP's cache of maps in GiB; 0 when all maps fit. With a cache the points are the same;
// maps are read again and again.
static double plan_cache(const struct orl_job *job, const struct orl_colmap_model *model,
                         const struct orl_names *names)
{
    double budget = orl_fuse_budget(job->params->max_ram_bytes) / GIB;
    double pixels = orl_fuse_pixels(model, names), all = orl_fuse_bytes(pixels) / GIB;
    double other = orl_fuse_bytes_beside_maps(pixels) / GIB;
    if (all <= budget)
        return 0;
    double cache = fmax(budget - other, CACHE_LEAST_GIB);
    orl_logf(job->log, ORL_LOG_INFO,
             "fuse: all maps take %.0f MiB and %.0f may be used; reading them through a cache of "
             "%.0f MiB, which is slower", 1024 * all, 1024 * budget, 1024 * cache);
    if (cache + other > budget)
        orl_logf(job->log, ORL_LOG_WARNING, "fuse: %.0f MiB are not enough for %.1f megapixels; it "
                 "takes about %.0f MiB; --fuse-cluster fuses fewer photographs at a time",
                 1024 * budget, 1e-6 * pixels, 1024 * (cache + other));
    return cache;
}

static enum orl_result fuse_args(struct orl_job *job, const char *workspace, const char *out,
                                 int min_pixels, double cache_gib, struct orl_colmap_args *args)
{
    orl_colmap_arg(args, "--workspace_path", "%s", workspace);
    orl_colmap_arg(args, "--output_path", "%s", out);
    orl_colmap_arg(args, "--input_type", "geometric");
    orl_colmap_arg(args, "--StereoFusion.min_num_pixels", "%d", min_pixels);
    // With several threads the points depend on thread timing. Fusion is fast enough with one.
    orl_colmap_arg(args, "--StereoFusion.num_threads", "1");
    if (job->params->masks_dir) {
        char *masks = orl_job_path(job, "masks");
        if (!masks)
            return ORL_ERR_MEMORY;
        orl_colmap_arg(args, "--StereoFusion.mask_path", "%s", masks);
        free(masks);
    }
    orl_colmap_arg(args, "--StereoFusion.use_cache", "%d", cache_gib > 0);
    if (cache_gib > 0)
        orl_colmap_arg(args, "--StereoFusion.cache_size", "%.4f", cache_gib);
    return ORL_OK;
}

// Reads the cloud that COLMAP fused and, for each point, how many photographs agree on it.
static enum orl_result read_cloud(const struct orl_job *job, const char *path,
                                  struct orl_points *points)
{
    enum orl_result result = orl_points_read(job->log, path, points);
    char *lists = result == ORL_OK ? orl_format(job->log, "%s.vis", path) : NULL;
    if (result == ORL_OK)
        result = lists ? orl_colmap_visibility_read(job->log, lists, points->count,
                                                    points->photographs)
                       : ORL_ERR_MEMORY;
    free(lists);
    return result;
}

// Runs COLMAP's fusion for points that at least `min_pixels` photographs agree on. `done` is the
// part of this fusion's work that is finished already.
static enum orl_result fuse_cloud(struct orl_job *job, const struct orl_fusion *fusion,
                                  int min_pixels, double done, struct orl_points *points)
{
    struct orl_colmap_args args = {0};
    char *out = orl_format(job->log, "%s/%d.ply", fusion->temp, min_pixels);
    enum orl_result result = out ? fuse_args(job, fusion->workspace, out, min_pixels,
                                             fusion->cache_gib, &args)
                                 : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_job_colmap(job, &(struct orl_colmap_run){
            .command = "stereo_fusion", .step = "fuse", .done = fusion->done + done,
            .share = 0.5, .total = fusion->total},
            &args);
    if (result == ORL_OK)
        result = read_cloud(job, out, points);
    free(out);
    return result;
}

// Removes outliers: points in front of the surfaces that photographs see, mostly bright sky around
// a dark statue. Reads each depth map once.
static enum orl_result drop_strays(const struct orl_job *job, const struct orl_colmap_model *model,
                                   const struct orl_names *names, struct orl_points *points)
{
    uint16_t *seen_past = orl_array(job->log, points->count, sizeof *seen_past);
    enum orl_result result = seen_past ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        struct orl_image depth = {0};
        if (!orl_names_contain(names, image->name))
            continue;
        char *path = orl_job_path(job, "stereo/depth_maps/%s.geometric.bin", image->name);
        if (!path)
            result = ORL_ERR_MEMORY;
        else if (orl_path_is_file(path)) // COLMAP writes no map without sources
            result = orl_colmap_map_read(job->log, path, &depth);
        if (depth.f32) {
            struct orl_view view = orl_colmap_image_view(model, image);
            orl_points_count_seen_past(points, &view, &depth, STRAY_TOLERANCE, seen_past);
        }
        orl_image_finish(&depth);
        free(path);
    }
    if (result == ORL_OK)
        orl_points_drop_seen_past(seen_past, points);
    free(seen_past);
    return result;
}

// Points that three photographs agree on are good. Points that only two agree on are noisier and
// hold more outliers, but they are the only points of places that few photographs see
// (docs/how/pipeline.md).
static enum orl_result join_clouds(const struct orl_job *job, struct orl_points *pairs,
                                   struct orl_points *points)
{
    const struct orl_radii_params radii = {ORL_RADII_DEFAULTS};
    const struct orl_thin_params thin = {ORL_THIN_DEFAULTS};
    if (pairs->count == 0)
        return orl_fail(job->log, ORL_ERR_DATA,
                        "no surface was found that two photographs agree on: take photographs "
                        "closer together, of textured and matt surfaces, or with --quality high");
    enum orl_result result = orl_points_set_radii(job->log, NULL, &radii, NULL, 0, pairs);
    return result == ORL_OK ? orl_points_add_thin(job->log, &thin, pairs, points) : result;
}

enum orl_result orl_fuse_photographs(struct orl_job *job, const struct orl_colmap_model *model,
                                     struct orl_fusion *fusion, struct orl_points *points)
{
    struct orl_points pairs = {0};
    *points = (struct orl_points){0};
    fusion->cache_gib = plan_cache(job, model, fusion->names);
    enum orl_result result = fuse_cloud(job, fusion, 2, 0, &pairs);
    if (result == ORL_OK)
        result = fuse_cloud(job, fusion, 3, 0.5, points);
    fusion->of_three = points->count;
    if (result == ORL_OK)
        result = join_clouds(job, &pairs, points);
    size_t joined = points->count;
    if (result == ORL_OK)
        result = drop_strays(job, model, fusion->names, points);
    fusion->strays = joined - points->count;
    orl_points_finish(&pairs);
    if (result != ORL_OK)
        orl_points_finish(points);
    return result;
}
