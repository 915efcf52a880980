// What other programs made: cameras, workspaces, meshes and databases of features.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/file.h"
#include "core/json.h"
#include "fuzz.h"
#include "preprocess/calibrate/database.h"
#include "preprocess/import/import_internal.h"
#include "scene/info.h"
#include "scene/known_internal.h"
#include "scene/mesh.h"

// What import does with each camera: completes it from a picture's size, then finds the camera of
// the undistorted picture.
static void use_camera(struct orl_known_cameras *known, size_t index, int width, int height)
{
    const struct orl_colmap_camera *camera = &known->model.cameras[index];
    if (orl_known_camera_settle(&fuzz_log, known, index, "a.jpg", width, height) != ORL_OK)
        return;
    fuzz_require(orl_camera_valid(&camera->pinhole), "a completed camera is usable");
    for (int max_size = 0; max_size <= 16; max_size += 16) {
        struct orl_camera target = orl_import_target(camera, max_size);
        fuzz_require(orl_camera_valid(&target), "an undistorted camera is usable");
        fuzz_require(!max_size || (target.width <= max_size && target.height <= max_size),
                     "an undistorted picture is as large as asked for");
    }
}

static void read_cameras(const char *path, double pixel_centre, const struct orl_known_gap *gap)
{
    enum { CAMERAS_MAX = 4 };
    struct orl_known_cameras known;
    if (orl_known_cameras_read(&fuzz_log, path, pixel_centre, &known) != ORL_OK)
        return;
    fuzz_require(known.model.image_count > 0, "a file of cameras has cameras");
    for (size_t i = 0; i < known.model.image_count; i++) {
        const struct orl_colmap_image *image = &known.model.images[i];
        fuzz_require(orl_colmap_camera_by_id(&known.model, image->camera_id) != NULL,
                     "a picture has a camera");
        fuzz_require(orl_pose_valid(&image->cam_from_world), "a pose is a pose");
        fuzz_require(!known.pictures || (image->id >= 1 && image->id <= known.picture_count),
                     "a picture has a path");
        for (size_t k = 0; k < image->point_count; k++)
            fuzz_require(image->points[k] < known.model.point_count, "observed points are there");
    }
    for (size_t i = 0; i < known.model.camera_count && i < CAMERAS_MAX; i++) {
        known.gaps[i] = *gap;
        use_camera(&known, i, 64, 48);
    }
    orl_known_cameras_finish(&known);
}

// The first byte's last two bits: the convention of pixel centres; the next two: what the file leaves open.
void fuzz_cameras_json(const uint8_t *data, size_t size)
{
    static const double centres[] = {-1, 0, 0.5, -1};
    static const struct orl_known_gap gaps[] = {{0}, {.centre = true}, {.side = 1}, {.fov_x_rad = 1}};
    int first = size ? data[0] : 0;
    json_t *root = NULL;
    // Other files are for the script (known_cameras.py).
    bool own = size && orl_json_parse(&fuzz_log, "it", data + 1, size - 1, &root) == ORL_OK &&
               orl_known_is_own(root);
    json_decref(root);
    if (!own)
        return;
    fuzz_save("cameras.json", data + 1, size - 1);
    read_cameras(fuzz_path("cameras.json"), centres[first & 3], &gaps[first >> 2 & 3]);
}

static void use_scene(const char *dir)
{
    struct orl_scene *scene;
    if (orl_scene_open(&fuzz_log, dir, &scene) != ORL_OK)
        return;
    fuzz_require(scene->photo_count > 0 && isfinite(scene->photo_distance), "a scene is usable");
    for (size_t i = 0; i < scene->photo_count; i++)
        fuzz_require(!orl_view_problem(&scene->photos[i].view), "a photograph's view is usable");
    for (size_t i = 0; i < scene->points.count; i++)
        fuzz_require(scene->points.radius[i] > 0 && isfinite(scene->points.radius[i]),
                     "points have radii");
    json_decref(orl_scene_info(&fuzz_log, scene));
    for (size_t i = 0; i < scene->photo_count; i++)
        (void)orl_scene_camera_users(scene, i);
    fuzz_require(orl_scene_set_frame(&fuzz_log, scene, 0) == ORL_ERR_ARGUMENT && scene->frame == -1,
                 "a still scene has no time steps");
    orl_scene_destroy(&scene);
}

static void use_unfinished(const char *dir)
{
    char *sparse = orl_path_join(&fuzz_log, dir, "sparse");
    struct orl_colmap_model model;
    struct orl_scene *scene;
    if (orl_colmap_read(&fuzz_log, sparse, &model) == ORL_OK) {
        if (orl_scene_open_unfinished(&fuzz_log, dir, &model, NULL, &scene) == ORL_OK)
            orl_scene_destroy(&scene);
        orl_colmap_finish(&model);
    }
    free(sparse);
}

// A folder with a model as text: imported, and opened as a scene. The first byte's last bit: is there
// a scene.json, and is the cloud points.ply?
void fuzz_workspace(const uint8_t *data, size_t size)
{
    static const char *const photographs[] = {"a.jpg", "b.jpg", "c.jpg"};
    static const char *const plain[] = {"ws/sparse/cameras.txt", "ws/sparse/points3D.txt",
                                        "ws/sparse/images.txt", "ws/fused.ply"};
    static const char *const whole[] = {"ws/sparse/cameras.txt", "ws/sparse/points3D.txt",
                                        "ws/sparse/images.txt", "ws/scene.json", "ws/points.ply"};
    bool is_scene = size && (data[0] & 1);
    if (orl_dir_make(&fuzz_log, fuzz_path("ws/sparse")) != ORL_OK ||
        orl_dir_make(&fuzz_log, fuzz_path("ws/images")) != ORL_OK)
        abort();
    for (size_t i = 0; i < ORL_COUNT(photographs); i++) {
        char name[32];
        snprintf(name, sizeof name, "ws/images/%s", photographs[i]);
        fuzz_save(name, data, 0);
    }
    unlink(fuzz_path("ws/scene.json"));
    fuzz_save_parts(is_scene ? whole : plain, is_scene ? ORL_COUNT(whole) : ORL_COUNT(plain),
                    data + (size > 0), size - (size > 0));
    read_cameras(fuzz_path("ws"), -1, &(struct orl_known_gap){0});
    use_scene(fuzz_path("ws"));
    use_unfinished(fuzz_path("ws"));
}

void fuzz_mesh(const uint8_t *data, size_t size)
{
    struct orl_mesh mesh, again;
    fuzz_save("mesh", data, size);
    if (orl_mesh_read(&fuzz_log, fuzz_path("mesh"), NULL, &mesh) != ORL_OK)
        return;
    fuzz_require(mesh.triangle_count > 0, "a mesh has faces");
    for (size_t i = 0; i < mesh.triangle_count; i++)
        for (int k = 0; k < 3; k++)
            fuzz_require(mesh.triangle[i][k] < mesh.vertex_count, "corners are there");
    fuzz_require(orl_mesh_set_normals(&fuzz_log, &mesh) == ORL_OK, "normals are found");
    for (size_t i = 0; i < mesh.vertex_count; i++)
        for (int k = 0; k < 3; k++)
            fuzz_require(isfinite(mesh.position[i][k]) && fabsf(mesh.normal[i][k]) <= 1.001f,
                         "vertices are usable");
    fuzz_require(orl_mesh_write(&fuzz_log, fuzz_path("again"), &mesh) == ORL_OK &&
                     orl_mesh_read(&fuzz_log, fuzz_path("again"), NULL, &again) == ORL_OK &&
                     again.triangle_count == mesh.triangle_count, "a mesh can be written");
    fuzz_require(orl_mesh_decimate(&fuzz_log, mesh.triangle_count / 2, &mesh) == ORL_OK,
                 "a mesh can be made simpler");
    orl_mesh_finish(&again);
    orl_mesh_finish(&mesh);
}

// Databases of parts: one is joined to the other, or gives its features to one that is made.
static void use_parts(struct orl_database *db)
{
    struct orl_database *made;
    char *part = strdup(fuzz_path("part.db")), *like = strdup(fuzz_path("like.db"));
    (void)!orl_database_add_photographs(db, part);
    (void)!orl_database_add_matches(db, part);
    unlink(like);
    if (orl_database_create_like(&fuzz_log, like, part, &made) == ORL_OK) {
        if (orl_database_begin(made) == ORL_OK && orl_database_take_features(made, "a.jpg") == ORL_OK)
            (void)!orl_database_commit(made);
        (void)!orl_database_detach(made);
    }
    orl_database_close(&made);
    free(part);
    free(like);
}

// COLMAP's database, as `prepare --resume` finds it.
void fuzz_database(const uint8_t *data, size_t size)
{
    struct orl_database *db;
    struct orl_features features;
    bool has;
    uint32_t matches[2][2] = {{0, 1}, {2, 3}};
    fuzz_save("database.db", data, size);
    if (orl_database_open(&fuzz_log, fuzz_path("database.db"), &db) != ORL_OK)
        return;
    if (orl_database_features(db, "a.jpg", 2, &features) == ORL_OK)
        fuzz_require(features.count <= 2 && features.descriptors, "as many features as asked for");
    free(features.descriptors);
    (void)!orl_database_features(db, "b.jpg", 0, &features);
    free(features.descriptors);
    (void)!orl_database_has_matches(db, 1, 2, &has);
    (void)!orl_database_write_matches(db, 2, 1, matches, ORL_COUNT(matches));
    (void)!orl_database_hide_spaces(db, true);
    (void)!orl_database_share_camera(db, "a.jpg", "b.jpg");
    fuzz_save("part.db", data, size);
    use_parts(db);
    orl_database_close(&db);
    unlink(fuzz_path("database.db-journal"));
}
