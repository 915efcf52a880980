#include "preprocess/import_densify.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"
#include "core/vec3.h"
#include "preprocess/calibrate/match.h"
#include "preprocess/job/colmap_run.h"
#include "preprocess/scene_json.h"
#include "preprocess/stages.h"

#define DATABASE ".oriel/known.db"

enum { PARTNERS = 20 }; // that a photograph is matched with, where they are many
static const double SAME_WAY = 0.5; // cosine of the angle between directions of view, at least

// --- a prepare job on existing photographs ---

static enum orl_result add_source(struct orl_job *job, const struct import_job *import,
                                  const struct import_view *view)
{
    struct orl_source *source = &job->sources[job->source_count++];
    const struct orl_camera *size = &import->targets[view->camera];
    *source = (struct orl_source){.name = orl_strdup(job->log, view->name),
                                  .given = orl_strdup(job->log, view->name),
                                  .path = orl_strdup(job->log, ORL_PATH(job->dir, "images/%s", view->name)),
                                  .width = size->width, .height = size->height,
                                  .test = view->test};
    if (view->masked)
        source->mask = orl_strdup(job->log, ORL_PATH(job->dir, "masks/%s.png", view->name));
    if (!source->name || !source->given || !source->path ||
        (view->masked && !source->mask))
        return ORL_ERR_MEMORY;
    // A frame of a clip has no EXIF.
    struct orl_picture_info info = {0};
    if (view->picture.kind == IMPORT_PICTURE)
        ORL_TRY(orl_picture_inspect(job->log, view->picture.path, &info));
    source->exif = info.exif;
    return ORL_OK;
}

static enum orl_result begin(struct orl_job *job, const struct import_job *import,
                             const struct orl_prepare_params *params)
{
    static const char *const dirs[] = {".oriel", "logs"};
    *job = (struct orl_job){.log = import->log, .progress = import->progress, .params = params,
                            .lock_fd = -1, .linear_scale = 1, .given = import->view_count,
                            .skipped = json_array(), .dir = realpath(import->dir, NULL)};
    if (!job->dir)
        return orl_fail(job->log, ORL_ERR_IO, "%s: %s", import->dir, strerror(errno));
    job->sources = orl_array(job->log, import->view_count, sizeof *job->sources);
    enum orl_result result = job->sources && job->skipped ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < import->view_count; i++)
        result = add_source(job, import, &import->views[i]);
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(dirs); i++)
        result = orl_dir_make(job->log, ORL_PATH(job->dir, "%s", dirs[i]));
    ORL_THEN(result, orl_stages_load(job));
    return result == ORL_OK ? orl_stages_begin(job, 0) : result;
}

// --- pairs of photographs ---

// The partners of view `a`, the nearest first; how many.
static size_t find_partners(const struct import_job *import, size_t a, bool all,
                            struct orl_ranked *partners)
{
    const struct orl_pose *pose = &import->views[a].image->cam_from_world;
    double eye[3], off[3];
    size_t count = 0;
    orl_pose_centre(pose, eye);
    for (size_t b = 0; b < import->view_count; b++) {
        const struct orl_pose *other = &import->views[b].image->cam_from_world;
        if (b == a || import->views[b].test ||
            (!all && orl_dot3(pose->r[2], other->r[2]) < SAME_WAY))
            continue;
        orl_pose_centre(other, off);
        for (int k = 0; k < 3; k++)
            off[k] -= eye[k];
        partners[count++] = (struct orl_ranked){orl_dot3(off, off), b};
    }
    qsort(partners, count, sizeof *partners, orl_order_ranked);
    return all || count < PARTNERS ? count : PARTNERS;
}

enum orl_result orl_import_pairs(const struct import_job *import, struct orl_pair_list *list)
{
    size_t train = 0, kept = 0;
    for (size_t i = 0; i < import->view_count; i++)
        train += !import->views[i].test;
    bool all = orl_match_way(ORL_MATCHING_AUTO, train) == ORL_MATCHING_EXHAUSTIVE;
    struct orl_ranked *partners = orl_array(import->log, import->view_count, sizeof *partners);
    *list = (struct orl_pair_list){
        .items = orl_array(import->log, train * (all ? train : PARTNERS), sizeof *list->items)};
    enum orl_result result = partners && list->items ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t a = 0; result == ORL_OK && a < import->view_count; a++) {
        size_t count = import->views[a].test ? 0 : find_partners(import, a, all, partners);
        for (size_t i = 0; i < count; i++) {
            uint32_t b = (uint32_t)partners[i].index;
            list->items[list->count++] = (struct orl_pair){a < b ? (uint32_t)a : b,
                                                           a < b ? b : (uint32_t)a};
        }
    }
    if (result == ORL_OK)
        qsort(list->items, list->count, sizeof *list->items, orl_order_pairs);
    for (size_t i = 0; i < list->count; i++) // most are in the list from both sides
        if (!kept || orl_order_pairs(&list->items[i], &list->items[kept - 1]) != 0)
            list->items[kept++] = list->items[i];
    list->count = kept;
    free(partners);
    if (result != ORL_OK)
        orl_pairs_finish(list);
    return result;
}

// --- sparse points ---

// Paths for COLMAP's commands.
struct paths {
    const char *database, *images, *list, *in, *out;
};

static enum orl_result find_features(struct orl_job *job, const struct paths *paths)
{
    struct orl_colmap_run run = {.command = "feature_extractor", .step = "features"};
    orl_colmap_arg(&run, "--database_path", "%s", paths->database);
    orl_colmap_arg(&run, "--image_path", "%s", paths->images);
    orl_colmap_arg(&run, "--image_list_path", "%s", paths->list);
    orl_colmap_arg(&run, "--ImageReader.camera_model", "PINHOLE");
    // As the model that is triangulated has them; otherwise photographs whose EXIF names one camera
    // share it.
    orl_colmap_arg(&run, "--ImageReader.single_camera_per_image", "1");
    orl_colmap_arg(&run, "--SiftExtraction.use_gpu", "%d", job->colmap_cuda);
    // COLMAP's database numbers photographs as they are finished, and triangulation requires that
    // the known cameras have the same numbers. With one thread, both are in order of name.
    orl_colmap_arg(&run, "--SiftExtraction.num_threads", "1");
    return orl_job_colmap(job, &run);
}

static enum orl_result match(struct orl_job *job, const struct import_job *import)
{
    struct orl_pair_list list;
    enum orl_result result = orl_import_pairs(import, &list);
    ORL_THEN(result, orl_match_list(job, DATABASE, false, &list));
    orl_pairs_finish(&list);
    return result;
}

// Photographs without matches give no points, and COLMAP 3.10 ends by a signal where a known camera is
// of such a one. Where no two match all stay, and take_points says what is wrong.
static enum orl_result leave_out_unconnected(struct orl_job *job, const struct paths *paths)
{
    struct orl_colmap_model model = {0};
    struct orl_database *db = NULL;
    size_t kept = 0;
    enum orl_result result = orl_colmap_read(job->log, paths->in, &model);
    ORL_THEN(result, orl_database_open(job->log, paths->database, &db));
    bool *connected = orl_array(job->log, model.image_count, sizeof *connected);
    if (result == ORL_OK && !connected)
        result = ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < model.image_count; i++) {
        result = orl_database_is_connected(db, model.images[i].id, &connected[i]);
        kept += connected[i];
    }
    if (result == ORL_OK && kept && kept < model.image_count)
        result = orl_colmap_write(job->log, paths->in, &model, connected);
    free(connected);
    orl_database_close(&db);
    orl_colmap_finish(&model);
    return result;
}

static enum orl_result triangulate(struct orl_job *job, const struct paths *paths)
{
    // COLMAP 3.8 stops with the first message when it triangulates no point, and 3.10 with the other
    // when no photographs match; take_points reports that clearly.
    struct orl_colmap_run run = {.command = "point_triangulator", .step = "triangulate",
                                 .tolerated = {"bundle_adjuster.Solve", "LoadDatabase"}};
    orl_colmap_arg(&run, "--database_path", "%s", paths->database);
    orl_colmap_arg(&run, "--image_path", "%s", paths->images);
    orl_colmap_arg(&run, "--input_path", "%s", paths->in);
    orl_colmap_arg(&run, "--output_path", "%s", paths->out);
    return orl_job_colmap(job, &run);
}

static enum orl_result write_train_list(const struct orl_job *job, const char *path)
{
    struct orl_names names = {0};
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++)
        if (!job->sources[i].test)
            result = orl_names_add(job->log, &names, job->sources[i].name);
    ORL_THEN(result, orl_job_write_list(job, path, &names));
    orl_names_finish(&names);
    return result;
}

// Takes the points alone: the poses are known and stay unchanged.
static enum orl_result take_points(const struct import_job *import, const struct paths *paths)
{
    struct orl_colmap_model model = {0};
    struct orl_names written = {0};
    enum orl_result result = orl_dir_list(import->log, paths->out, &written);
    if (result == ORL_OK && written.count)
        result = orl_colmap_read(import->log, paths->out, &model);
    orl_names_finish(&written);
    if (result == ORL_OK && model.point_count < 3)
        result = orl_fail(import->log, ORL_ERR_DATA, "the photographs have only %zu points in "
                          "common: are the cameras those of these photographs? Where they stand too far apart for points, "
                          "--mesh hull makes a surface of silhouettes",
                          model.point_count);
    ORL_THEN(result, orl_import_write_model(import, "sparse", false, &(struct import_points){&model, true}));
    orl_colmap_finish(&model);
    return result;
}

static enum orl_result make_sparse_points(struct orl_job *job, const struct import_job *import)
{
    // Points that no photograph is known to see are of no use here.
    struct orl_colmap_model bare = import->known.model;
    bare.point_count = 0;
    const struct import_points known = {&bare, false};
    const struct paths paths = {
        ORL_PATH(job->dir, DATABASE), ORL_PATH(job->dir, "images"),
        ORL_PATH(job->dir, ".oriel/train.txt"), ORL_PATH(job->dir, ".oriel/known"),
        ORL_PATH(job->dir, ".oriel/triangulated")};
    ORL_TRY(orl_job_find_colmap(job));
    ORL_TRY(write_train_list(job, paths.list));
    ORL_TRY(orl_import_write_model(import, ".oriel/known", true, &known));
    ORL_TRY(orl_dir_make(job->log, paths.out));
    ORL_TRY(find_features(job, &paths));
    ORL_TRY(match(job, import));
    ORL_TRY(leave_out_unconnected(job, &paths));
    ORL_TRY(triangulate(job, &paths));
    return take_points(import, &paths);
}

// True when the file of cameras says which photographs see its points, as stereo needs to know.
static bool has_views(const struct orl_colmap_model *model)
{
    size_t count = 0;
    for (size_t i = 0; i < model->image_count && model->point_count; i++)
        count += model->images[i].point_count;
    return count > 0;
}

enum orl_result orl_import_densify(struct import_job *import)
{
    struct orl_job job;
    struct orl_prepare_params params = import->params->densify;
    params.max_size = import->params->max_size;
    params.masks_dir = NULL;
    for (size_t i = 0; i < import->view_count; i++)
        if (import->views[i].masked)
            params.masks_dir = "masks";
    enum orl_result result = begin(&job, import, &params);
    if (result == ORL_OK && !has_views(&import->known.model))
        result = make_sparse_points(&job, import);
    ORL_THEN(result, orl_stages_run_points(&job));
    ORL_THEN(result, orl_scene_json_write(&job));
    if (result == ORL_OK && params.keep == ORL_KEEP_MINIMAL)
        result = orl_job_remove(&job, "stereo");
    // An import cannot be resumed, so the job's own files are of no use.
    ORL_THEN(result, orl_job_remove(&job, ".oriel"));
    orl_job_close(&job);
    return result;
}
