// The scene's files besides the photographs: sparse model, points, mesh, manifest.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "core/memory.h"
#include "io/picture.h"
#include "preprocess/import/import_internal.h"
#include "scene/colmap_internal.h"
#include "scene/cones.h"
#include "scene/manifest.h"
#include "oriel/points.h"
#include "scene/free_space.h"
#include "scene/radius_limits.h"

// --- sparse/ ---

// Sets the points that a photograph sees, if their model has the photograph.
static void set_points(const struct import_points *points, const char *known_name,
                       struct orl_colmap_image *image)
{
    const char *name = points->renamed ? image->name : known_name;
    const struct orl_colmap_image *from = orl_colmap_image_by_name(points->model, name);
    image->points = from ? from->points : NULL;
    image->point_count = from ? from->point_count : 0;
}

enum orl_result orl_import_write_model(const struct import_job *job, const char *name, bool for_database,
                                       const struct import_points *points)
{
    const struct orl_colmap_model *known = &job->known.model;
    struct orl_colmap_model model = {.points = points->model->points,
                                     .point_count = points->model->point_count};
    model.cameras = orl_array(job->log, known->camera_count + job->view_count, sizeof *model.cameras);
    model.images = orl_array(job->log, job->view_count, sizeof *model.images);
    const char *dir = ORL_PATH(job->dir, "%s", name);
    enum orl_result result = model.cameras && model.images ? orl_dir_make(job->log, dir) : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && !for_database && i < known->camera_count; i++)
        if (job->targets[i].width) // true when the camera has a picture
            model.cameras[model.camera_count++] =
                orl_colmap_pinhole(known->cameras[i].id, &job->targets[i]);
    for (size_t i = 0; result == ORL_OK && i < job->view_count; i++) {
        const struct import_view *view = &job->views[i];
        if (for_database && view->test)
            continue;
        struct orl_colmap_image *image = &model.images[model.image_count];
        *image = *view->image;
        image->name = view->name;
        image->id = (uint32_t)++model.image_count; // in order of name, as COLMAP's database numbers
                                                   // them
        if (for_database) {
            image->camera_id = image->id;
            model.cameras[model.camera_count++] =
                orl_colmap_pinhole(image->id, &job->targets[view->camera]);
        }
        set_points(points, view->image->name, image);
    }
    ORL_THEN(result, orl_colmap_write(job->log, dir, &model, NULL));
    free(model.cameras);
    free(model.images);
    return result;
}

// --- points.ply ---

static struct orl_view view_of(const struct import_job *job, size_t i)
{
    return (struct orl_view){job->targets[job->views[i].camera],
                             job->views[i].image->cam_from_world};
}

// Estimates radii and normals where the file has none.
static enum orl_result complete_points(const struct import_job *job, struct orl_points *points)
{
    size_t count = 0, known = 0;
    for (size_t i = 0; i < points->count; i++)
        known += points->radius[i] > 0;
    if (known)
        return ORL_OK;
    const struct orl_radii_params params = {ORL_RADII_DEFAULTS};
    struct orl_view *views = orl_array(job->log, job->view_count, sizeof *views);
    ORL_TRY_MEMORY(views);
    for (size_t i = 0; i < job->view_count; i++)
        if (!job->views[i].test)
            views[count++] = view_of(job, i);
    enum orl_result result =
        orl_points_drop_in_free_space(job->log, job->progress, views, count, points);
    ORL_THEN(result, orl_points_find_radii(job->log, job->progress, &params, views, count, points));
    free(views);
    return result;
}

enum orl_result orl_import_write_points(const struct import_job *job, size_t *count)
{
    struct orl_points points;
    const char *file = job->params->points_file;
    ORL_TRY(file ? orl_points_read(job->log, file, job->known.origin, &points)
                 : orl_points_init(job->log, &points, 0));
    enum orl_result result = ORL_OK;
    if (file && !points.count)
        result = orl_fail(job->log, ORL_ERR_DATA, "%s: no usable points", file);
    else if (points.count)
        result = complete_points(job, &points);
    ORL_THEN(result, orl_points_write(job->log, ORL_PATH(job->dir, "points.ply"), &points, false, NULL));
    *count = points.count;
    orl_points_finish(&points);
    return result;
}

// --- mesh.ply ---

// folder: "" or "frames/NNNNN/"
static enum orl_result read_silhouettes(const struct import_job *job, const char *folder,
                                        struct orl_silhouette *silhouettes, size_t *count)
{
    for (size_t i = 0; i < job->view_count; i++) {
        if (job->views[i].test || !job->views[i].masked)
            continue;
        struct orl_silhouette *one = &silhouettes[*count];
        const char *path = ORL_PATH(job->dir, "%smasks/%s.png", folder, job->views[i].name);
        one->view = view_of(job, i);
        ORL_TRY(orl_picture_read(job->log, path, 1, &one->mask));
        ++*count;
    }
    return ORL_OK;
}

static enum orl_result carve_mesh(struct import_job *job, const char *folder,
                                  struct orl_mesh *mesh)
{
    size_t count = 0;
    struct orl_silhouette *silhouettes =
        orl_array(job->log, job->view_count, sizeof *silhouettes);
    enum orl_result result =
        silhouettes ? read_silhouettes(job, folder, silhouettes, &count) : ORL_ERR_MEMORY;
    if (result == ORL_OK && !count)
        result = orl_fail(job->log, ORL_ERR_DATA, "a hull needs silhouettes, and no picture "
                          "has a mask or alpha: --masks, --silhouettes dark or --background");
    ORL_THEN(result, orl_cones_mesh(job->log, silhouettes, count, job->params->hull_side,
                                    (size_t)job->params->hull_triangles, &job->said_endless, mesh));
    for (size_t i = 0; i < count; i++)
        orl_image_finish(&silhouettes[i].mask);
    free(silhouettes);
    return result;
}

static enum orl_result write_mesh(struct import_job *job, const char *folder,
                                  size_t *triangles)
{
    struct orl_mesh mesh = {0};
    const char *file = job->params->mesh;
    enum orl_result result = file ? orl_mesh_read(job->log, file, job->known.origin, &mesh)
                                  : carve_mesh(job, folder, &mesh);
    if (result == ORL_OK && !mesh.normal)
        result = orl_mesh_set_normals(job->log, &mesh);
    ORL_THEN(result, orl_mesh_write(job->log, ORL_PATH(job->dir, "%smesh.ply", folder), &mesh));
    *triangles = mesh.triangle_count;
    orl_mesh_finish(&mesh);
    return result;
}

// A hull belongs to its time step; the mesh of a file belongs to all.
static enum orl_result carve_time_steps(struct import_job *job)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < job->frame_count; i++) {
        char folder[32];
        size_t triangles;
        snprintf(folder, sizeof folder, "frames/%05zu/", i);
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        result = write_mesh(job, folder, &triangles);
        if (result == ORL_ERR_DATA) { // the subject may have left the room
            orl_logf(job->log, ORL_LOG_WARNING, "time step %zu has no hull: it shows that of the scene", i);
            result = ORL_OK;
        }
        orl_progress_report(job->progress, "hulls", (double)(i + 1), (double)job->frame_count,
                            NULL);
    }
    return result;
}

enum orl_result orl_import_write_mesh(struct import_job *job, size_t *triangles)
{
    *triangles = 0;
    if (!job->params->mesh && !job->params->hull_side)
        return ORL_OK;
    ORL_TRY(write_mesh(job, "", triangles));
    return job->params->hull_side ? carve_time_steps(job) : ORL_OK;
}

// --- scene.json ---

static json_t *photographs(const struct import_job *job)
{
    json_t *list = json_array();
    for (size_t i = 0; i < job->view_count; i++)
        json_array_append_new(
            list, json_pack("{s:s, s:s, s:n, s:i, s:[i,i,i], s:i, s:b}", "name", job->views[i].name,
                            "split", job->views[i].test ? "test" : "train", "exposure_ev",
                            "series", 0, "gain", 1, 1, 1, "orientation",
                            job->views[i].orientation, "mask",
                            job->views[i].masked));
    return list;
}

static json_t *left_out(const struct import_job *job)
{
    const struct orl_colmap_model *known = &job->known.model;
    json_t *list = json_array();
    for (size_t i = 0; i < known->image_count; i++)
        if (job->why_not[i])
            json_array_append_new(list, json_pack("{s:s, s:s}", "name", known->images[i].name,
                                                  "why", job->why_not[i]));
    return list;
}

// Adds {name in the scene: checksum} of a file, or of all files in a folder.
static enum orl_result sum_files(const struct import_job *job, const char *path, json_t *sums)
{
    if (orl_progress_cancelled(job->progress))
        return ORL_ERR_CANCELLED;
    if (!orl_path_is_dir(path)) {
        char sum[ORL_CHECKSUM_SIZE];
        ORL_TRY(orl_file_checksum(job->log, path, sum));
        return json_object_set_new(sums, path + strlen(job->dir) + 1, json_string(sum)) == 0
                   ? ORL_OK : orl_fail(job->log, ORL_ERR_MEMORY, "%s: no memory for its checksum", path);
    }
    struct orl_names names;
    enum orl_result result = orl_dir_list(job->log, path, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++)
        if (strcmp(names.items[i], "logs") != 0) // of COLMAP's runs
            result = sum_files(job, ORL_PATH(path, "%s", names.items[i]), sums);
    orl_names_finish(&names);
    return result;
}

// Of a scene that import makes alone.
static enum orl_result make_manifest(const struct import_job *job, size_t points, json_t **root)
{
    json_int_t used = (json_int_t)job->view_count, test = 0;
    for (size_t i = 0; i < job->view_count; i++)
        test += job->views[i].test;
    *root = json_pack(
        "{s:s, s:i, s:s, s:{s:n, s:i, s:I, s:I, s:I, s:I, s:n, s:I, s:I}, s:o, s:n, s:{}}", "format",
        "oriel scene", "version", ORL_MANIFEST_VERSION, "made_by", "oriel " ORL_VERSION, "counts", "given",
        "skipped", 0, "used", used, "registered", used, "train", used - test, "test", test, "left_out",
        "sparse_points", (json_int_t)job->known.model.point_count, "points", (json_int_t)points, "photographs",
        photographs(job), "left_out", "stages");
    return *root ? ORL_OK : orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the scene");
}

static json_t *settings(const struct import_job *job)
{
    static const char *const silhouettes[] = {
        [ORL_SILHOUETTES_STATED] = "stated",
        [ORL_SILHOUETTES_GIVEN] = "given",
        [ORL_SILHOUETTES_DARK] = "dark", [ORL_SILHOUETTES_BACKGROUND] = "background"};
    static const char *const points[] = {[ORL_IMPORT_STATED_POINTS] = "none",
                                         [ORL_IMPORT_NO_POINTS] = "none",
                                         [ORL_IMPORT_CLOUD] = "file",
                                         [ORL_IMPORT_DENSIFY] = "densify"};
    const struct orl_import_params *p = job->params;
    return json_pack("{s:s, s:s, s:s, s:i, s:i}", "cameras", orl_path_name(p->cameras),
                     "silhouettes", silhouettes[p->silhouettes], "points",
                     points[p->points], "max_size", p->max_size, "hull", p->hull_side);
}

// The room that the user states, else the one of the file of cameras.
static json_t *room_json(const struct import_job *job)
{
    struct orl_room room = job->params->room;
    for (int k = 0; k < 3; k++) {
        room.low[k] -= job->known.origin[k];
        room.high[k] -= job->known.origin[k];
    }
    return orl_manifest_room(room.known ? &room : &job->known.room);
}

// Sets what import states besides the stages.
static void set_import(const struct import_job *job, json_t *root)
{
    const double *o = job->known.origin;
    json_object_set_new(root, "import", settings(job));
    json_object_set_new(root, "room", room_json(job));
    if (o[0] != 0 || o[1] != 0 || o[2] != 0)
        json_object_set_new(root, "origin", json_pack("[f,f,f]", o[0], o[1], o[2]));
}

enum orl_result orl_import_write_manifest(const struct import_job *job, size_t points, size_t triangles)
{
    json_t *root = NULL, *sums = json_object();
    const char *path = ORL_PATH(job->dir, "scene.json");
    enum orl_result result = sum_files(job, job->dir, sums);
    json_object_del(sums, "scene.json"); // which prepare's stages wrote and this changes
    if (result == ORL_OK)
        result = job->params->points == ORL_IMPORT_DENSIFY ? orl_json_read(job->log, path, &root)
                                                           : make_manifest(job, points, &root);
    if (result == ORL_OK) {
        json_t *numbers = json_object_get(root, "counts"), *missing = left_out(job);
        set_import(job, root);
        json_object_set_new(numbers, "given", json_integer((json_int_t)job->known.model.image_count));
        json_object_set_new(numbers, "left_out", json_integer((json_int_t)json_array_size(missing)));
        json_object_set_new(numbers, "triangles", json_integer((json_int_t)triangles));
        json_object_set_new(numbers, "frames", json_integer((json_int_t)job->frame_count));
        json_object_set_new(root, "left_out", missing);
        json_object_set(root, "checksums", sums);
        result = orl_json_write(job->log, path, root);
    }
    json_decref(sums);
    json_decref(root);
    return result;
}
