#include "oriel/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "scene/colmap.h"
#include "scene/depth_buffer.h"
#include "scene/ground_plane.h"
#include "scene/manifest.h"
#include "scene/free_space.h"
#include "scene/point_lod.h"
#include "scene/radius_limits.h"
#include "scene/upright.h"

// A still scene has no frames. Its `frame` may be 0 when the struct was only zeroed.
static bool shows_time_step(const struct orl_scene *scene)
{
    return scene->frame_count > 0 && scene->frame >= 0;
}

static enum orl_result set_photo(const struct orl_log *log, const char *dir,
                                 const struct orl_colmap_model *model,
                                 const struct orl_colmap_image *image, struct orl_photo *photo)
{
    const struct orl_colmap_camera *camera = orl_colmap_camera_by_id(model, image->camera_id);
    if (camera->model > 1)
        return orl_fail(log, ORL_ERR_DATA,
                        "%s: photograph %s is not undistorted (its camera is not PINHOLE); "
                        "run colmap image_undistorter first", dir, image->name);
    photo->name = orl_strdup(log, image->name);
    photo->view = (struct orl_view){camera->pinhole, image->cam_from_world};
    for (int i = 0; i < 3; i++)
        photo->gain[i] = 1;
    photo->response = -1;
    return photo->name ? ORL_OK : ORL_ERR_MEMORY;
}

// A scene from an untrusted source must not show or publish other files of this machine.
static enum orl_result check_inside(const struct orl_log *log, const struct orl_scene *scene,
                                    const char *path)
{
    return orl_path_is_inside(scene->dir, path) ||
                   (scene->time_steps_dir && orl_path_is_inside(scene->time_steps_dir, path))
               ? ORL_OK
               : orl_fail(log, ORL_ERR_DATA,
                          "%s: leads out of the scene through a symbolic link; put the file itself "
                          "there", path);
}

// Files may be missing, but for the photographs.
static enum orl_result check_files(const struct orl_log *log, struct orl_scene *scene)
{
    const struct orl_file_path mesh = orl_scene_mesh_path(scene);
    for (size_t i = 0; i < scene->photo_count; i++)
        for (enum orl_photo_file kind = ORL_FILE_PHOTO; kind <= ORL_FILE_LINEAR; kind++) {
            const struct orl_file_path path = orl_scene_file(scene, i, kind);
            bool there = orl_path_is_file(path.text);
            if (there)
                ORL_TRY(check_inside(log, scene, path.text));
            if (!there && kind == ORL_FILE_PHOTO)
                return orl_fail(log, ORL_ERR_NOT_FOUND, "%s/images/%s: this photograph is missing",
                                scene->dir, scene->photos[i].name);
            if (kind == ORL_FILE_LINEAR)
                scene->photos[i].linear = there && !shows_time_step(scene);
        }
    return orl_path_is_file(mesh.text) ? check_inside(log, scene, mesh.text) : ORL_OK;
}

enum orl_result orl_scene_set_frame(const struct orl_log *log, struct orl_scene *scene, int frame)
{
    int before = scene->frame;
    if (frame < -1 || (frame >= 0 && (size_t)frame >= scene->frame_count))
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s: no time step %d: there are %zu", scene->dir,
                        frame, scene->frame_count);
    scene->frame = frame;
    enum orl_result result = check_files(log, scene);
    if (result != ORL_OK) {
        scene->frame = before;
        if (check_files(NULL, scene) != ORL_OK) // restores photo->linear
            return result;
    }
    return result;
}

// Frames are numbered from 0 without gaps; folders after a gap are ignored.
static size_t count_frames(const char *dir)
{
    size_t count = 0;
    while (orl_path_is_dir(ORL_PATH(dir, "frames/%05zu", count)))
        count++;
    return count;
}

static enum orl_result set_photos(const struct orl_log *log, struct orl_scene *scene,
                                  const struct orl_colmap_model *model)
{
    if (model->image_count == 0)
        return orl_fail(log, ORL_ERR_DATA, "%s: no photographs", scene->dir);
    scene->photos = orl_array(log, model->image_count, sizeof *scene->photos);
    ORL_TRY_MEMORY(scene->photos);
    for (size_t i = 0; i < model->image_count; i++) {
        scene->photo_count = i + 1; // counted first, so that a half-made one is released
        ORL_TRY(set_photo(log, scene->dir, model, &model->images[i], &scene->photos[i]));
    }
    return check_files(log, scene);
}

// Sorts the values. share: of them that are smaller, [0, 1); 0 without any.
static double quantile(double *values, size_t count, double share)
{
    if (!count)
        return 0;
    qsort(values, count, sizeof *values, orl_order_doubles);
    return values[(size_t)(share * (double)count)];
}

static double distance(const double a[3], const double b[3])
{
    double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

// Sorts what one photograph sees, and lowers *near to a quarter of the distance beyond which all but
// a twentieth of it lies: few things that a photograph sees may be outliers.
static void lower_near(double *values, size_t count, double *near)
{
    double nearest = 0.25 * quantile(values, count, 0.05);
    if (nearest > 0 && (*near == 0 || nearest < *near))
        *near = nearest;
}

// For scenes without sparse observations: distances to some of the points in the picture.
static size_t sample_distances(struct orl_scene *scene, double *values, size_t per_photo)
{
    size_t count = 0, step = scene->points.count / per_photo + 1;
    for (size_t i = 0; i < scene->photo_count; i++) {
        if (scene->photos[i].test)
            continue;
        const struct orl_view *view = &scene->photos[i].view;
        double centre[3];
        size_t first = count;
        orl_pose_centre(&view->cam_from_world, centre);
        for (size_t p = 0; p < scene->points.count; p += step) {
            const float *at = scene->points.position[p];
            const double world[3] = {(double)at[0], (double)at[1], (double)at[2]};
            double pixel[2], depth;
            if (orl_view_shows(view, world, pixel, &depth))
                values[count++] = distance(centre, world);
        }
        lower_near(values + first, count - first, &scene->near_distance);
    }
    return count;
}

// For scenes without points: distances to the place that the photographs look at.
static size_t middle_distances(const struct orl_scene *scene, double *values)
{
    double eye[3], middle[3];
    size_t count = 0;
    if (!orl_scene_middle(scene, middle))
        return 0;
    for (size_t i = 0; i < scene->photo_count; i++) {
        orl_pose_centre(&scene->photos[i].view.cam_from_world, eye);
        values[count++] = distance(eye, middle);
    }
    return count;
}

static enum orl_result set_distances(const struct orl_log *log, struct orl_scene *scene,
                                     const struct orl_colmap_model *model)
{
    enum { SAMPLES = 1024 };
    size_t total = 0, count = 0;
    for (size_t i = 0; i < model->image_count; i++)
        total += model->images[i].point_count;
    double *values = orl_array(log, total + scene->photo_count * SAMPLES, sizeof *values);
    ORL_TRY_MEMORY(values);
    for (size_t i = 0; i < model->image_count; i++) {
        if (scene->photos[i].test) // photographs and model images have equal indices
            continue;
        double centre[3];
        size_t first = count;
        orl_pose_centre(&model->images[i].cam_from_world, centre);
        for (size_t p = 0; p < model->images[i].point_count; p++)
            values[count++] = distance(centre, model->points[model->images[i].points[p]].position);
        lower_near(values + first, count - first, &scene->near_distance);
    }
    if (!count)
        count = sample_distances(scene, values, SAMPLES);
    if (!count)
        count = middle_distances(scene, values);
    scene->photo_distance = count ? quantile(values, count, 0.5) : 1;
    free(values);
    return ORL_OK;
}

enum orl_result orl_scene_training_views(const struct orl_log *log, const struct orl_scene *scene,
                                         struct orl_view **views, size_t *count)
{
    *count = 0;
    *views = orl_array(log, scene->photo_count, sizeof **views);
    for (size_t i = 0; *views && i < scene->photo_count; i++)
        if (!scene->photos[i].test)
            (*views)[(*count)++] = scene->photos[i].view;
    return *views ? ORL_OK : ORL_ERR_MEMORY;
}

// Drops points without a radius, which would not be drawn.
static void drop_flat_points(const struct orl_log *log, struct orl_scene *scene)
{
    size_t all = scene->points.count, dropped = orl_points_drop_flat(&scene->points);
    if (dropped)
        orl_logf(log, ORL_LOG_WARNING, "%s: %zu of %zu points have no radius: dropped",
                 scene->dir, dropped, all);
}

static enum orl_result compute_radii(const struct orl_log *log, struct orl_scene *scene)
{
    const struct orl_radii_params params = {ORL_RADII_DEFAULTS};
    struct orl_view *views;
    size_t count;
    enum orl_result result = orl_scene_training_views(log, scene, &views, &count);
    ORL_THEN(result, orl_points_drop_in_free_space(log, NULL, views, count, &scene->points));
    ORL_THEN(result, orl_points_find_radii(log, NULL, &params, views, count, &scene->points));
    free(views);
    return result;
}

static enum orl_result read_points(const struct orl_log *log, struct orl_scene *scene,
                                   const char *path, bool may_be_empty)
{
    enum orl_result result = orl_points_read(log, path, NULL, &scene->points);
    // A scene with a manifest may have no points: methods that use silhouettes need none.
    if (result != ORL_OK || (may_be_empty && !scene->points.count))
        return result;
    size_t known = 0;
    for (size_t i = 0; i < scene->points.count; i++)
        known += scene->points.radius[i] > 0;
    if (known)
        drop_flat_points(log, scene);
    else if (scene->points.count)
        result = compute_radii(log, scene);
    if (result == ORL_OK && scene->points.count == 0)
        result = orl_fail(log, ORL_ERR_DATA, "%s: no usable points", path);
    return result;
}

static enum orl_result check_files_inside(const struct orl_log *log, const struct orl_scene *scene,
                                          const char *dir)
{
    struct orl_names names;
    if (!orl_path_is_dir(dir))
        return ORL_OK; // the reader reports what is missing
    enum orl_result result = orl_dir_list(log, dir, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        const char *path = ORL_PATH(dir, "%s", names.items[i]);
        if (orl_path_is_file(path))
            result = check_inside(log, scene, path);
    }
    orl_names_finish(&names);
    return result;
}

enum orl_result orl_scene_read_model(const struct orl_log *log, const struct orl_scene *scene,
                                     struct orl_colmap_model *model)
{
    const char *first = ORL_PATH(scene->dir, "sparse/0");
    const char *dir = orl_path_is_dir(first) ? first : ORL_PATH(scene->dir, "sparse");
    ORL_TRY(check_files_inside(log, scene, dir));
    return orl_colmap_read(log, dir, model);
}

// Adds the points. The photographs and their `test` flags must be set before.
static enum orl_result add_points(const struct orl_log *log, struct orl_scene *scene,
                                  const struct orl_colmap_model *model, const char *path,
                                  bool may_be_empty)
{
    ORL_TRY(scene->lod ? orl_lod_sample(scene->lod, ORL_LOD_SAMPLE, &scene->points)
                       : read_points(log, scene, path, may_be_empty));
    ORL_TRY(set_distances(log, scene, model));
    if (!scene->ground.known)
        ORL_TRY(orl_ground_find(log, scene, &scene->ground));
    return ORL_OK;
}

static enum orl_result create(const struct orl_log *log, const char *dir, struct orl_scene **out)
{
    *out = orl_array(log, 1, sizeof **out);
    ORL_TRY_MEMORY(*out);
    (*out)->dir = orl_strdup(log, dir);
    (*out)->frame = -1;
    (*out)->frame_count = count_frames(dir);
    return (*out)->dir ? ORL_OK : ORL_ERR_MEMORY;
}

// `prepared`: has the folder a manifest? `cloud`: the file of its points; `points`: are they read?
static enum orl_result look(const struct orl_log *log, const char *dir, bool prepared, const char *cloud,
                            bool points)
{
    if (!orl_path_is_dir(dir))
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no such folder", dir);
    if (!prepared)
        ORL_TRY(orl_manifest_check_unfinished(log, dir));
    if (orl_path_is_file(cloud) || (prepared && !points))
        return ORL_OK;
    return prepared ? orl_fail(log, ORL_ERR_NOT_FOUND, "%s: points.ply is missing", dir)
                    : orl_fail(log, ORL_ERR_NOT_FOUND,
                               "%s: not a scene (no scene.json) nor a COLMAP dense workspace "
                               "(no fused.ply)", dir);
}

static enum orl_result open_scene(const struct orl_log *log, const char *dir, bool points,
                                  struct orl_scene **out)
{
    const char *manifest = ORL_PATH(dir, "scene.json"), *levels = ORL_PATH(dir, ORL_LOD_NAME);
    bool prepared = orl_path_is_file(manifest), paged = prepared && points && orl_path_is_file(levels);
    const char *cloud = paged ? levels : ORL_PATH(dir, "%s", prepared ? "points.ply" : "fused.ply");
    struct orl_colmap_model model = {0};
    enum orl_result result = create(log, dir, out);
    ORL_THEN(result, look(log, dir, prepared, cloud, points));
    if (points)
        ORL_THEN(result, check_inside(log, *out, cloud));
    if (prepared)
        ORL_THEN(result, check_inside(log, *out, manifest));
    ORL_THEN(result, orl_scene_read_model(log, *out, &model));
    ORL_THEN(result, set_photos(log, *out, &model));
    if (paged)
        ORL_THEN(result, orl_lod_open(log, cloud, &(*out)->lod));
    if (prepared)
        ORL_THEN(result, orl_manifest_read(log, manifest, points && !paged, *out));
    if (points)
        ORL_THEN(result, add_points(log, *out, &model, cloud, prepared));
    orl_colmap_finish(&model);
    if (result != ORL_OK)
        orl_scene_destroy(out);
    return result;
}

enum orl_result orl_scene_open(const struct orl_log *log, const char *dir, struct orl_scene **out)
{
    return open_scene(log, dir, true, out);
}

enum orl_result orl_scene_open_photos(const struct orl_log *log, const char *dir,
                                      struct orl_scene **out)
{
    return open_scene(log, dir, false, out);
}

enum orl_result orl_scene_open_model(const struct orl_log *log, const char *dir,
                                     const struct orl_colmap_model *model, struct orl_scene **out)
{
    enum orl_result result = create(log, dir, out);
    ORL_THEN(result, set_photos(log, *out, model));
    if (result != ORL_OK)
        orl_scene_destroy(out);
    return result;
}

enum orl_result orl_scene_open_unfinished(const struct orl_log *log, const char *dir,
                                          const struct orl_colmap_model *model,
                                          const struct orl_names *test, struct orl_scene **out)
{
    const char *lod = ORL_PATH(dir, ORL_LOD_NAME);
    enum orl_result result = orl_scene_open_model(log, dir, model, out);
    if (result == ORL_OK && orl_path_is_file(lod))
        result = orl_lod_open(log, lod, &(*out)->lod);
    for (size_t i = 0; result == ORL_OK && i < (*out)->photo_count; i++)
        (*out)->photos[i].test = test && orl_names_contain(test, (*out)->photos[i].name);
    ORL_THEN(result, add_points(log, *out, model, ORL_PATH(dir, "points.ply"), true));
    if (result != ORL_OK)
        orl_scene_destroy(out);
    return result;
}

void orl_scene_destroy(struct orl_scene **handle)
{
    struct orl_scene *scene = handle ? *handle : NULL;
    if (!scene)
        return;
    for (size_t i = 0; i < scene->photo_count; i++)
        free(scene->photos[i].name);
    free(scene->photos);
    free(scene->responses);
    for (size_t i = 0; i < scene->tuned_count; i++) {
        free(scene->tuned[i].method);
        free(scene->tuned[i].key);
        free(scene->tuned[i].name);
    }
    free(scene->tuned);
    free(scene->defaults.method);
    free(scene->defaults.textures);
    orl_points_finish(&scene->points);
    orl_lod_close(&scene->lod);
    free(scene->dir);
    free(scene);
    *handle = NULL;
}

size_t orl_scene_point_count(const struct orl_scene *scene)
{
    return scene->lod ? (size_t)scene->lod->points : scene->points.count;
}

int orl_scene_find_photo(const struct orl_scene *scene, const char *name)
{
    for (size_t i = 0; i < scene->photo_count; i++)
        if (strcmp(scene->photos[i].name, name) == 0)
            return (int)i;
    for (size_t i = 0; i < scene->photo_count; i++)
        if (orl_path_is_named(scene->photos[i].name, name))
            return (int)i;
    return -1;
}

static const char *time_steps_of(const struct orl_scene *scene)
{
    return scene->time_steps_dir ? scene->time_steps_dir : scene->dir;
}

struct orl_file_path orl_scene_file(const struct orl_scene *scene, size_t photo, enum orl_photo_file kind)
{
    static const struct {
        const char *folder, *ending;
        bool moves; // is there one of each time step?
    } kinds[] = {[ORL_FILE_PHOTO] = {"images", "", true},
                 [ORL_FILE_MASK] = {"masks", ".png", true},
                 [ORL_FILE_OCCLUDERS] = {"occluders", ".png", false},
                 [ORL_FILE_BACKGROUND] = {"background", ".png", false},
                 [ORL_FILE_LINEAR] = {"images_linear", ".exr", false}};
    struct orl_file_path path = {""};
    char frame[32] = "";
    if (kinds[kind].moves && shows_time_step(scene))
        snprintf(frame, sizeof frame, "frames/%05d/", scene->frame);
    orl_path_print(path.text, *frame ? time_steps_of(scene) : scene->dir, "%s%s/%s%s", frame, kinds[kind].folder,
                   scene->photos[photo].name, kinds[kind].ending);
    return path;
}

struct orl_file_path orl_scene_mesh_path(const struct orl_scene *scene)
{
    struct orl_file_path path = {""};
    if (shows_time_step(scene) &&
        orl_path_is_file(orl_path_print(path.text, time_steps_of(scene), "frames/%05d/mesh.ply", scene->frame)))
        return path;
    orl_path_print(path.text, scene->dir, "mesh.ply");
    return path;
}
