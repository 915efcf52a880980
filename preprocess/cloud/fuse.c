#include "preprocess/cloud/fuse.h"

#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/lock.h"
#include "preprocess/cloud/close_hull.h"
#include "preprocess/cloud/fuse_memory.h"
#include "preprocess/cloud/fuse_photographs.h"
#include "scene/point_stream.h"

enum { CLUSTER_MAX = 400 }; // photographs that are fused together when nobody asks for more

enum orl_result orl_fuse_clusters(const struct orl_log *log, const struct orl_colmap_model *model,
                                  const struct orl_names *train, int asked, double budget,
                                  struct orl_clusters *clusters)
{
    size_t size = (size_t)asked;
    ORL_TRY(asked ? ORL_OK : orl_fuse_plan_size(log, model, train, CLUSTER_MAX, budget, &size));
    return orl_clusters_make(log, model, train, size, clusters);
}

// The size that an earlier run with these photographs and settings has chosen; 0: none.
static size_t chosen_before(const struct orl_job *job)
{
    const json_t *chosen = json_object_get(job->stages, "fusion");
    const char *key = orl_json_text(chosen, "key");
    json_int_t size = json_integer_value(json_object_get(chosen, "cluster_size"));
    bool same = key && strcmp(key, job->keys[ORL_STAGE_FUSE]) == 0;
    return same && size > 0 && size <= CLUSTER_MAX ? (size_t)size : 0;
}

enum orl_result orl_fuse_choose(struct orl_job *job, const struct orl_colmap_model *model,
                                const struct orl_names *train, size_t *size)
{
    size_t max_ram = job->params->max_ram_bytes;
    *size = max_ram ? 0 : chosen_before(job);
    if (*size)
        return ORL_OK;
    ORL_TRY(orl_fuse_plan_size(job->log, model, train, CLUSTER_MAX, orl_fuse_budget(max_ram), size));
    json_t *chosen = json_pack("{s:s, s:I}", "key", job->keys[ORL_STAGE_FUSE], "cluster_size",
                               (json_int_t)*size);
    if (json_object_set_new(job->stages, "fusion", chosen) != 0)
        return orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the stages");
    return orl_job_save_stages(job);
}

json_t *orl_stage_fuse_settings(const struct orl_job *job)
{
    size_t most = 0;
    for (size_t i = 0; i < job->source_count; i++)
        most += !job->sources[i].test;
    // One fusion of all has no "cluster" in the key, so older keys stay valid. A size that memory
    // decides is not in it either: a fusion is not done again because other memory is free.
    int size = job->params->fuse_cluster ? job->params->fuse_cluster : CLUSTER_MAX;
    return json_pack("{s:o*}", "cluster", most > (size_t)size ? json_integer(size) : NULL);
}

// --- one cluster ---

// Fuses a cluster and writes the points that belong to it.
static enum orl_result fuse_members(struct orl_job *job, const struct orl_clusters *clusters,
                                    int cluster, const char *out)
{
    struct orl_names names = {0};
    struct orl_points points = {0};
    enum orl_result result = orl_clusters_photographs(job->log, clusters, cluster, &names);
    ORL_THEN(result, orl_fuse_photographs(job, clusters->model, &names, cluster,
                                          (double)clusters->count, &points));
    ORL_THEN(result, orl_clusters_keep_own(job->log, clusters, cluster, &points));
    ORL_THEN(result, orl_points_write(job->log, out, &points, false, NULL));
    orl_points_finish(&points);
    orl_names_finish(&names);
    return result;
}

static enum orl_result fuse_cluster(struct orl_job *job, const struct orl_clusters *clusters,
                                    int cluster)
{
    const char *out = ORL_FUSE_CLUSTER_PATH(job->dir, clusters->size, cluster, ".ply");
    int fd = -1;
    bool taken = false;
    ORL_TRY(orl_file_make_folder(job->log, out));
    enum orl_result result =
        orl_lock(job->log, ORL_FUSE_CLUSTER_PATH(job->dir, clusters->size, cluster, ".lock"), false, &fd, &taken);
    if (result == ORL_OK && taken)
        result = orl_fail(job->log, ORL_ERR_ARGUMENT, "%s: another oriel is fusing this cluster",
                          out);
    if (result == ORL_OK && orl_path_is_file(out))
        orl_logf(job->log, ORL_LOG_INFO, "fuse: cluster %d is there already", cluster + 1);
    else if (result == ORL_OK)
        result = fuse_members(job, clusters, cluster, out);
    orl_unlock(&fd);
    return result;
}

// --- the stage ---

// Adds what a cluster's file has, and counts it; counts only where there is no writer.
static enum orl_result add_cluster(const struct orl_job *job, const struct orl_clusters *clusters,
                                   int cluster, struct orl_point_writer *writer, uint64_t *count)
{
    enum { READ_POINTS = 1 << 16 };
    struct orl_point_stream *stream = NULL;
    struct orl_points points = {0};
    uint64_t total = 0;
    size_t read = writer != NULL;
    enum orl_result result = orl_point_stream_open(
        job->log, ORL_FUSE_CLUSTER_PATH(job->dir, clusters->size, cluster, ".ply"), &stream, &total);
    if (result == ORL_OK && writer)
        result = orl_points_init(job->log, &points, READ_POINTS);
    while (result == ORL_OK && read) {
        result = orl_point_stream_next(stream, READ_POINTS, &points, &read);
        ORL_THEN(result, orl_point_writer_add(writer, &points));
    }
    *count += total;
    orl_points_finish(&points);
    orl_point_stream_close(&stream);
    return result;
}

// The clusters' points one after the other, never all in memory.
static enum orl_result fuse_clusters(struct orl_job *job, const struct orl_clusters *clusters,
                                     const char *path, uint64_t *count)
{
    struct orl_point_writer writer = {0};
    enum orl_result result = ORL_OK;
    uint64_t again = 0;
    for (int c = 0; result == ORL_OK && c < (int)clusters->count; c++)
        if ((result = fuse_cluster(job, clusters, c)) == ORL_OK)
            result = add_cluster(job, clusters, c, NULL, count);
    ORL_THEN(result, orl_point_writer_begin(job->log, path, *count, false, NULL, &writer));
    for (int c = 0; result == ORL_OK && c < (int)clusters->count; c++)
        result = add_cluster(job, clusters, c, &writer, &again);
    ORL_THEN(result, orl_point_writer_end(&writer));
    orl_atomic_abort(&writer.file);
    return result;
}

// All photographs at once.
static enum orl_result fuse_all(struct orl_job *job, const struct orl_colmap_model *model,
                                const struct orl_names *train, const char *path, uint64_t *count,
                                json_t *record)
{
    struct orl_points points = {0};
    enum orl_result result = orl_fuse_photographs(job, model, train, 0, 1, &points);
    if (result == ORL_OK && job->params->hull != ORL_HULL_NONE)
        result = orl_close_hull(job, model, train, &points, record);
    ORL_THEN(result, orl_points_write(job->log, path, &points, false, NULL));
    *count = points.count;
    orl_points_finish(&points);
    return result;
}

// The clusters of --fuse-cluster, or those that fit in memory.
static enum orl_result make_clusters(struct orl_job *job, const struct orl_colmap_model *model,
                                     const struct orl_names *train, struct orl_clusters *clusters)
{
    size_t size = (size_t)job->params->fuse_cluster;
    enum orl_result result = size ? ORL_OK : orl_fuse_choose(job, model, train, &size);
    ORL_THEN(result, orl_clusters_make(job->log, model, train, size, clusters));
    if (result == ORL_OK && !job->params->fuse_cluster && clusters->count > 1)
        orl_logf(job->log, ORL_LOG_INFO, "fuse: %zu clusters of at most %zu of the %zu "
                 "photographs, and %zu more to help each%s", clusters->count, size, train->count,
                 orl_clusters_helpers(size), size < CLUSTER_MAX ? ", so that they fit in memory"
                                                                 : "");
    return result;
}

enum orl_result orl_stage_fuse(struct orl_job *job, json_t *record)
{
    uint64_t points = 0;
    struct orl_names train = {0};
    struct orl_clusters clusters = {0};
    const struct orl_colmap_model *model = NULL;
    const char *path = ORL_PATH(job->dir, ".oriel/fused.ply");
    enum orl_result result = orl_job_sparse(job, &model);
    ORL_THEN(result, orl_job_train_names(job, &train));
    ORL_THEN(result, make_clusters(job, model, &train, &clusters));
    if (result == ORL_OK && clusters.count > 1)
        result = fuse_clusters(job, &clusters, path, &points);
    else if (result == ORL_OK)
        result = fuse_all(job, model, &train, path, &points, record);
    ORL_THEN(result, orl_job_remove(job, "stereo/fused"));
    if (result == ORL_OK) {
        json_object_set_new(record, "clusters", json_integer((json_int_t)clusters.count));
        if (clusters.count > 1)
            json_object_set_new(record, "cluster_size", json_integer((json_int_t)clusters.size));
        json_object_set_new(record, "tool", json_string("built-in fusion"));
        json_object_set_new(record, "points", json_integer((json_int_t)points));
        orl_progress_report(job->progress, "fuse", 1, 1, NULL);
    }
    orl_clusters_finish(&clusters);
    orl_names_finish(&train);
    return result;
}

// --- a cluster as a job ---

static enum orl_result fuse_one(struct orl_job *job, const struct orl_fuse_params *params)
{
    const struct orl_colmap_model *model = NULL;
    struct orl_clusters clusters = {0};
    struct orl_names train = {0};
    enum orl_result result = orl_job_sparse(job, &model);
    ORL_THEN(result, orl_job_train_names(job, &train));
    ORL_THEN(result, orl_fuse_clusters(job->log, model, &train, params->size,
                                       orl_fuse_budget(params->max_ram_bytes), &clusters));
    if (result == ORL_OK && (clusters.count < 2 || clusters.count != (size_t)params->count))
        result = orl_fail(job->log, ORL_ERR_ARGUMENT, "%s: %zu photographs are fused in %zu "
                          "cluster%s, not in %d", job->dir, train.count, clusters.count,
                          clusters.count == 1 ? "" : "s", params->count);
    ORL_THEN(result, fuse_cluster(job, &clusters, params->cluster));
    orl_clusters_finish(&clusters);
    orl_names_finish(&train);
    return result;
}

enum orl_result orl_fuse_cluster(const struct orl_log *log, const char *scene,
                                 const struct orl_fuse_params *params,
                                 const struct orl_progress *progress)
{
    struct orl_job job;
    const struct orl_prepare_params prepare = {
        .out = scene, .masks_dir = params->masks ? "masks" : NULL,
        .max_ram_bytes = params->max_ram_bytes};
    enum orl_result result = orl_job_attach(&job, log, &prepare, progress);
    ORL_THEN(result, orl_job_take_sources(&job));
    ORL_THEN(result, fuse_one(&job, params));
    orl_job_close(&job);
    return result;
}
