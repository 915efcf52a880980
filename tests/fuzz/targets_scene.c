// Models, maps, clouds, manifests and camera paths.
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "core/file.h"
#include "core/json.h"
#include "core/vec3.h"
#include "fuzz.h"
#include "preprocess/job/exposure_list.h"
#include "scene/colmap.h"
#include "scene/manifest.h"
#include "oriel/path.h"
#include "scene/point_lod_internal.h"
#include "scene/radius_limits.h"
#include "scene/tuned_settings.h"

static void use_model(const struct orl_colmap_model *model)
{
    for (size_t i = 0; i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        const struct orl_colmap_camera *camera = orl_colmap_camera_by_id(model, image->camera_id);
        fuzz_require(camera && orl_camera_valid(&camera->pinhole), "a picture has a camera");
        fuzz_require(orl_pose_valid(&image->cam_from_world), "a pose is a pose");
        fuzz_require(orl_colmap_image_by_name(model, image->name) == image,
                     "a picture has one name");
        fuzz_require(!orl_view_problem(&(struct orl_view){orl_colmap_image_view(model, image).camera,
                                                          image->cam_from_world}),
                     "a picture's view is usable");
        for (size_t k = 0; k < image->point_count; k++)
            fuzz_require(image->points[k] < model->point_count, "observed points are there");
    }
    for (size_t i = 0; i < model->camera_count && i < 8; i++) {
        double pixel[2];
        orl_colmap_camera_project(&model->cameras[i], (const double[2]){0.3, -0.2}, pixel);
        (void)orl_colmap_camera_reaches_corners(&model->cameras[i]);
    }
}

static void read_model(const char *dir)
{
    struct orl_colmap_model model;
    if (orl_colmap_read(&fuzz_log, dir, &model) == ORL_OK)
        use_model(&model);
    orl_colmap_finish(&model);
}

void fuzz_colmap_binary(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"cameras.bin", "points3D.bin", "images.bin"};
    fuzz_save_parts(names, ORL_COUNT(names), data, size);
    read_model(fuzz_path("."));
}

void fuzz_colmap_text(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"cameras.txt", "points3D.txt", "images.txt"};
    fuzz_save_parts(names, ORL_COUNT(names), data, size);
    read_model(fuzz_path("."));
}

// What was read is written, and read again the same.
void fuzz_depth_map(const uint8_t *data, size_t size)
{
    struct orl_image image, again;
    fuzz_save("map.bin", data, size);
    if (orl_colmap_map_read(&fuzz_log, fuzz_path("map.bin"), &image) != ORL_OK)
        return;
    fuzz_require(orl_colmap_map_write(&fuzz_log, fuzz_path("again.bin"), &image) == ORL_OK &&
                     orl_colmap_map_read(&fuzz_log, fuzz_path("again.bin"), &again) == ORL_OK,
                 "a map can be written");
    fuzz_require(orl_image_bytes(&image) == orl_image_bytes(&again) &&
                     memcmp(image.data, again.data, orl_image_bytes(&image)) == 0,
                 "a map stays what it is");
    orl_image_finish(&image);
    orl_image_finish(&again);
}

static void use_views(struct orl_points *points)
{
    static const struct orl_radii_limits limits = {ORL_RADII_LIMITS_DEFAULTS};
    const struct orl_view view = {{64, 48, 50, 50, 32, 24},
                                  {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 5}}};
    fuzz_require(orl_points_limit_radii(&fuzz_log, &limits, &view, 1, points) == ORL_OK,
                 "radii are limited");
}

static void use_points(struct orl_points *points)
{
    static const struct orl_radii_params radii = {ORL_RADII_DEFAULTS};
    const struct orl_view view = {.cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 5}}};
    struct orl_points other;
    for (size_t i = 0; i < points->count; i++)
        fuzz_require(orl_point_usable(points->position[i]) && points->radius[i] >= 0 &&
                         isfinite(points->radius[i]), "points are usable");
    if (points->count > 256)
        return;
    fuzz_require(orl_points_write(&fuzz_log, fuzz_path("again.ply"), points, false, NULL) == ORL_OK &&
                     orl_points_read(&fuzz_log, fuzz_path("again.ply"), NULL, &other) == ORL_OK &&
                     other.count == points->count, "points can be written");
    fuzz_require(orl_points_set_radii(&fuzz_log, NULL, &radii, &view, 1, points) == ORL_OK,
                 "radii are found");
    for (size_t i = 0; i < points->count; i++)
        fuzz_require(points->radius[i] > 0 && isfinite(points->radius[i]), "radii are usable");
    orl_points_finish(&other);
    use_views(points);
}

void fuzz_ply(const uint8_t *data, size_t size)
{
    struct orl_points points;
    fuzz_save("points.ply", data, size);
    if (orl_points_read(&fuzz_log, fuzz_path("points.ply"), NULL, &points) == ORL_OK)
        use_points(&points);
    orl_points_finish(&points);
}

static void use_sample(struct orl_points *points)
{
    for (size_t i = 0; i < points->count; i++)
        fuzz_require(orl_point_usable(points->position[i]) && isfinite(points->radius[i]),
                     "a sampled point can be used");
    orl_points_finish(points);
}

// Reads all of points.lod, and a few of its points, if it can be opened.
static size_t use_lod(void)
{
    enum { FEW = 1000 };
    struct orl_lod *lod;
    struct orl_points points;
    size_t count = 0;
    if (orl_lod_open(&fuzz_log, fuzz_path(ORL_LOD_NAME), &lod) != ORL_OK)
        return 0;
    for (size_t page = 0, first, children; page < lod->page_count; page++) {
        (void)orl_lod_children(lod, page, &first, &children);
        fuzz_require(first + children <= page, "children lie before their parents");
    }
    if (orl_lod_sample(lod, SIZE_MAX, &points) == ORL_OK) {
        count = points.count;
        use_sample(&points);
    }
    if (orl_lod_read_cloud(&fuzz_log, fuzz_path("."), FEW, &points) == ORL_OK)
        use_sample(&points);
    orl_lod_close(&lod);
    return count;
}

static enum orl_result write_lod(void)
{
    static const struct orl_lod_params params = {ORL_LOD_DEFAULTS, .max_bytes = 1};
    char *cloud = strdup(fuzz_path("points.ply"));
    enum orl_result result = orl_lod_write(&fuzz_log, NULL, &params, cloud,
                                           fuzz_path(ORL_LOD_NAME));
    free(cloud);
    return result;
}

// The hashes of a changed file are made anew, so that what lies behind them is tried.
static void seal_lod(uint8_t *file, size_t length)
{
    size_t pages = (length - LOD_PAGES_AT) / (sizeof(struct orl_lod_data) + sizeof(struct orl_lod_page));
    uint8_t *table = file + LOD_PAGES_AT + pages * sizeof(struct orl_lod_data);
    for (size_t i = 0; i < pages; i++) {
        uint64_t hash = XXH3_64bits(file + LOD_PAGES_AT + i * sizeof(struct orl_lod_data),
                                    sizeof(struct orl_lod_data));
        memcpy(table + i * sizeof(struct orl_lod_page) + offsetof(struct orl_lod_page, hash), &hash,
               sizeof hash);
    }
    uint64_t hash = XXH3_64bits(table, pages * sizeof(struct orl_lod_page));
    memcpy(file + offsetof(struct lod_header, table_hash), &hash, sizeof hash);
}

// Saves the levels of detail of a cloud, in which each five bytes of the input change one: its
// place and its value.
static void save_changed_lod(size_t count, const uint8_t *data, size_t size)
{
    struct orl_points points;
    uint8_t *file;
    size_t length;
    fuzz_require(orl_points_init(NULL, &points, count) == ORL_OK, "memory");
    for (size_t i = 0; i < count; i++) {
        points.position[i][0] = (float)(i % 20);
        points.position[i][1] = (float)(i / 20);
        points.radius[i] = 1;
    }
    fuzz_require(orl_points_write(&fuzz_log, fuzz_path("points.ply"), &points, false, NULL) == ORL_OK &&
                     write_lod() == ORL_OK && use_lod() == count &&
                     orl_file_read(&fuzz_log, fuzz_path(ORL_LOD_NAME), SIZE_MAX / 2, &file,
                                   &length) == ORL_OK,
                 "what is written can be read");
    for (; size >= 5; data += 5, size -= 5) {
        uint32_t at;
        memcpy(&at, data, sizeof at);
        file[at % length] = data[4];
    }
    seal_lod(file, length);
    fuzz_save(ORL_LOD_NAME, file, length - size); // 0 to 4 bytes left over: the file is cut
    free(file);
    orl_points_finish(&points);
}

// The first byte: a PLY follows, to be divided; or changes of a file of levels, from 128 on of one
// that has more than the lowest level.
void fuzz_lod(const uint8_t *data, size_t size)
{
    enum { ONE_PAGE = 300, TWO_PAGES = ORL_LOD_BLOCKS * ORL_BLOCK_POINTS + 300 };
    if (size && data[0] % 2) {
        fuzz_save("points.ply", data + 1, size - 1);
        if (write_lod() == ORL_OK)
            fuzz_require(use_lod() > 0, "a cloud that was divided can be read");
    } else {
        save_changed_lod(size && data[0] >= 128 ? TWO_PAGES : ONE_PAGE, data + (size > 0),
                         size - (size > 0));
        (void)use_lod();
    }
}

struct orl_scene *fuzz_scene(void)
{
    static const char *const names[] = {"a.jpg", "b.jpg", "c.jpg"};
    struct orl_scene *scene = calloc(1, sizeof *scene);
    scene->dir = strdup(fuzz_path("."));
    scene->photo_count = ORL_COUNT(names);
    scene->photos = calloc(scene->photo_count, sizeof *scene->photos);
    for (size_t i = 0; i < scene->photo_count; i++) {
        const double eye[3] = {(double)i, 0, 0}, target[3] = {1, 0, 9}, up[3] = {0, -1, 0};
        scene->photos[i].name = strdup(names[i]);
        scene->photos[i].view.camera = (struct orl_camera){64, 48, 50, 50, 32, 24};
        scene->photos[i].view.cam_from_world = orl_pose_look_at(eye, target, up);
    }
    return scene;
}

void fuzz_manifest(const uint8_t *data, size_t size)
{
    struct orl_scene *scene = fuzz_scene();
    char manifest[128];
    snprintf(manifest, sizeof manifest, "%s", fuzz_path("scene.json"));
    fuzz_save("scene.json", data, size);
    fuzz_save("points.ply", data, 0);
    if (orl_manifest_read(&fuzz_log, manifest, true, scene) == ORL_OK) {
        size_t bad, files;
        (void)!orl_manifest_check(&fuzz_log, scene->dir, &bad, &files);
        json_decref(orl_manifest_ground(&scene->ground));
        json_t *record = json_pack("{s:{s:f}}", "settings", "scale", 0.5);
        fuzz_require(orl_tuned_write(&fuzz_log, scene->dir, "oriel", record) == ORL_OK,
                     "settings can be kept");
    }
    orl_scene_destroy(&scene);
}

void fuzz_stages(const uint8_t *data, size_t size)
{
    mkdir(fuzz_path(".oriel"), 0700);
    fuzz_save(".oriel/stages.json", data, size);
    (void)!orl_manifest_check_unfinished(&fuzz_log, fuzz_path("."));
}

static void use_path(struct orl_path *path)
{
    for (size_t i = 0; i < path->count; i++)
        fuzz_require(!orl_view_problem(&path->views[i]), "views are usable");
    orl_path_finish(path);
}

// Walks past photographs of these views, and circles what they look at.
static void use_as_photos(const struct orl_path *path, struct orl_scene *scene)
{
    struct orl_path made;
    size_t count = scene->photo_count < path->count ? scene->photo_count : path->count;
    for (size_t i = 0; i < count; i++)
        scene->photos[i].view = path->views[i];
    if (orl_path_through_photos(&fuzz_log, scene, 5, &made) == ORL_OK)
        use_path(&made);
    if (orl_path_around(&fuzz_log, scene, 5, &made) == ORL_OK)
        use_path(&made);
}

static void read_path(const char *name)
{
    struct orl_scene *scene = fuzz_scene();
    struct orl_path path, circle;
    double eye[3], first[3];
    fuzz_require(orl_path_around(&fuzz_log, scene, 5, &circle) == ORL_OK, "a circle is made");
    for (size_t i = 0; i < circle.count; i++) {
        orl_pose_centre(&circle.views[i].cam_from_world, i ? eye : first);
        double from[3] = {first[0] - 1, first[1], first[2] - 9};
        double to[3] = {eye[0] - 1, eye[1], eye[2] - 9};
        fuzz_require(!i || fabs(orl_dot3(from, from) - orl_dot3(to, to)) < 1e-6, "it is a circle");
    }
    use_path(&circle);
    if (orl_path_read(&fuzz_log, scene, fuzz_path(name), &path) == ORL_OK) {
        fuzz_require(path.count > 0, "a path has views");
        use_as_photos(&path, scene);
        use_path(&path);
    }
    orl_scene_destroy(&scene);
}

void fuzz_path_json(const uint8_t *data, size_t size)
{
    fuzz_save("path.json", data, size);
    read_path("path.json");
}

// The first byte's last bit: is there a cameras.txt?
void fuzz_path_text(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"cameras.txt", "images.txt"};
    bool both = size && (data[0] & 1);
    data += size > 0;
    size -= size > 0;
    unlink(fuzz_path("cameras.txt"));
    fuzz_save_parts(both ? names : names + 1, both ? 2 : 1, data, size);
    read_path("images.txt");
}

void fuzz_exposures(const uint8_t *data, size_t size)
{
    struct orl_exposure_list list;
    fuzz_save("exposures.csv", data, size);
    if (orl_exposure_list_read(&fuzz_log, fuzz_path("exposures.csv"), &list) == ORL_OK) {
        (void)orl_exposure_list_find(&list, "a.jpg");
        for (size_t i = 0; i < list.count; i++)
            fuzz_require(fabs(list.items[i].ev) <= 64, "exposures are usable");
    }
    orl_exposure_list_finish(&list);
}
