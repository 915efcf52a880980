// The stage mesh: a triangle mesh of the scene, made by COLMAP (docs/how/pipeline.md).
#include <stdlib.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "preprocess/job/colmap_run.h"
#include "scene/mesh.h"
#include "scene/point_lod.h"

enum { MESH_POINTS = 16 << 20 }; // of a larger cloud

// Depth of Poisson's octree, below which density leaves are trimmed, and the most triangles.
struct detail {
    int depth, trim;
    size_t triangles;
};

static struct detail detail_of(const struct orl_prepare_params *params)
{
    static const struct detail details[] = {[ORL_QUALITY_DRAFT] = {9, 6, 200000},
                                            [ORL_QUALITY_STANDARD] = {10, 7, 500000},
                                            [ORL_QUALITY_HIGH] = {11, 8, 1000000}};
    return details[params->quality];
}

// --- input ---

// Drops points far outside the box of the middle 98 % of the points. The octree divides the bounding
// box, so that a few outliers at the horizon would leave the subject a handful of cells.
static enum orl_result crop(const struct orl_log *log, struct orl_points *points)
{
    static const float margin = 0.25f; // of the box's side
    float *values = orl_array(log, points->count, sizeof *values);
    float low[3], high[3];
    ORL_TRY_MEMORY(values);
    for (int k = 0; k < 3; k++) {
        for (size_t i = 0; i < points->count; i++)
            values[i] = points->position[i][k];
        qsort(values, points->count, sizeof *values, orl_order_floats);
        float first = values[points->count / 100];
        float last = values[points->count - 1 - points->count / 100];
        low[k] = first - margin * (last - first);
        high[k] = last + margin * (last - first);
    }
    free(values);
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i++) {
        const float *p = points->position[i];
        bool inside = true;
        for (int k = 0; k < 3; k++)
            inside = inside && p[k] >= low[k] && p[k] <= high[k];
        if (inside)
            orl_points_copy(points, i, points, kept++);
    }
    points->count = kept;
    return ORL_OK;
}

static enum orl_result write_points(const struct orl_job *job, const char *to)
{
    struct orl_points points = {0};
    enum orl_result result = orl_lod_read_cloud(job->log, job->dir, MESH_POINTS, &points);
    if (result == ORL_OK && points.count)
        result = crop(job->log, &points);
    ORL_THEN(result, orl_points_write(job->log, to, &points, false, NULL));
    orl_points_finish(&points);
    return result;
}

// The sparse model of the photographs that are not held out.
static enum orl_result write_train_model(struct orl_job *job, const char *to)
{
    const struct orl_colmap_model *model;
    ORL_TRY(orl_job_sparse(job, &model));
    ORL_TRY(orl_dir_make(job->log, to));
    bool *keep = orl_array(job->log, model->image_count, sizeof *keep);
    ORL_TRY_MEMORY(keep);
    for (size_t i = 0; i < model->image_count; i++)
        keep[i] = !orl_job_find(job, model->images[i].name)->test;
    enum orl_result result = orl_colmap_write(job->log, to, model, keep);
    free(keep);
    return result;
}

// --- meshing ---

static enum orl_result run_mesher(struct orl_job *job, const char *input, const char *output)
{
    const struct detail detail = detail_of(job->params);
    bool poisson = job->params->mesh == ORL_MESH_POISSON;
    struct orl_colmap_run run = {.command = poisson ? "poisson_mesher" : "delaunay_mesher", .step = "mesh"};
    orl_colmap_arg(&run, "--input_path", "%s", input);
    orl_colmap_arg(&run, "--output_path", "%s", output);
    if (poisson) {
        orl_colmap_arg(&run, "--PoissonMeshing.depth", "%d", detail.depth);
        orl_colmap_arg(&run, "--PoissonMeshing.trim", "%d", detail.trim);
        // With several threads the mesh depends on thread timing.
        orl_colmap_arg(&run, "--PoissonMeshing.num_threads", "1");
    } else {
        orl_colmap_arg(&run, "--input_type", "sparse");
    }
    enum orl_result result = orl_job_colmap(job, &run);
    if (result != ORL_OK && !poisson)
        orl_logf(job->log, ORL_LOG_ERROR, "delaunay needs a COLMAP that was built with CGAL; "
                 "--mesh poisson needs none");
    return result;
}

static enum orl_result write_mesh(const struct orl_job *job, const char *from, size_t *triangles)
{
    struct orl_mesh mesh = {0};
    size_t most = detail_of(job->params).triangles;
    enum orl_result result = orl_mesh_read(job->log, from, NULL, &mesh);
    if (result == ORL_OK && mesh.triangle_count > most)
        result = orl_mesh_decimate(job->log, most, &mesh);
    ORL_THEN(result, orl_mesh_set_normals(job->log, &mesh));
    ORL_THEN(result, orl_mesh_write(job->log, ORL_PATH(job->dir, "mesh.ply"), &mesh));
    *triangles = mesh.triangle_count;
    orl_mesh_finish(&mesh);
    return result;
}

enum orl_result orl_stage_mesh(struct orl_job *job, json_t *record)
{
    bool poisson = job->params->mesh == ORL_MESH_POISSON;
    size_t triangles = 0;
    const char *input = ORL_PATH(job->dir, ".oriel/mesh.tmp/%s", poisson ? "points.ply" : "sparse");
    const char *output = ORL_PATH(job->dir, ".oriel/mesh.tmp/mesh.ply");
    ORL_TRY(orl_job_find_colmap(job));
    ORL_TRY(orl_job_fresh_dir(job, ".oriel/mesh.tmp"));
    ORL_TRY(poisson ? write_points(job, input) : write_train_model(job, input));
    ORL_TRY(run_mesher(job, input, output));
    ORL_TRY(write_mesh(job, output, &triangles));
    ORL_TRY(orl_job_remove(job, ".oriel/mesh.tmp"));
    json_object_set_new(record, "tool", json_sprintf("COLMAP %s, %s", job->colmap_version,
                                                     orl_prepare_mesh_names[job->params->mesh]));
    json_object_set_new(record, "triangles", json_integer((json_int_t)triangles));
    orl_progress_report(job->progress, "mesh", 1, 1, NULL);
    return ORL_OK;
}
