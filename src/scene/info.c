#include "scene/info.h"

#include "core/file.h"
#include "core/json.h"
#include "scene/manifest.h"

void orl_points_bounds(const struct orl_points *points, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++)
        low[k] = high[k] = points->count ? (double)points->position[0][k] : 0;
    for (size_t i = 1; i < points->count; i++)
        for (int k = 0; k < 3; k++) {
            double v = (double)points->position[i][k];
            low[k] = v < low[k] ? v : low[k];
            high[k] = v > high[k] ? v : high[k];
        }
}

static bool same_camera(const struct orl_camera *a, const struct orl_camera *b)
{
    return a->width == b->width && a->height == b->height && a->fx == b->fx && a->fy == b->fy &&
           a->cx == b->cx && a->cy == b->cy;
}

size_t orl_scene_camera_users(const struct orl_scene *scene, size_t photo)
{
    const struct orl_camera *camera = &scene->photos[photo].view.camera;
    size_t users = 0;
    for (size_t k = 0; k < scene->photo_count; k++) {
        bool same = same_camera(camera, &scene->photos[k].view.camera);
        if (same && k < photo)
            return 0;
        users += same;
    }
    return users;
}

size_t orl_scene_silhouettes(const struct orl_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        count += scene->photos[i].masked;
    return count;
}

static json_t *photo_json(const struct orl_photo *photo)
{
    const struct orl_camera *c = &photo->view.camera;
    double centre[3];
    orl_pose_centre(&photo->view.cam_from_world, centre);
    return json_pack("{s:o, s:s, s:[i,i], s:[f,f], s:[f,f], s:[f,f,f], s:o, s:i, s:f}", "name",
                     orl_json_string(photo->name), "split", photo->test ? "test" : "train", "size",
                     c->width, c->height, "focal_px", c->fx, c->fy, "centre_px", c->cx, c->cy, "position",
                     centre[0], centre[1], centre[2], "exposure_ev",
                     photo->has_exposure ? json_real(photo->exposure_ev) : json_null(), "series",
                     photo->series, "occluded", (double)photo->occluded);
}

json_t *orl_scene_info(const struct orl_log *log, const struct orl_scene *scene)
{
    double low[3], high[3];
    size_t test = 0;
    json_t *photos = json_array(), *manifest = NULL;
    for (size_t i = 0; i < scene->photo_count; i++) {
        test += scene->photos[i].test;
        json_array_append_new(photos, photo_json(&scene->photos[i]));
    }
    orl_points_bounds(&scene->points, low, high);
    const char *path = ORL_PATH(scene->dir, "scene.json");
    enum orl_result result = orl_path_is_file(path) ? orl_json_read(log, path, &manifest) : ORL_OK;
    json_t *root = result != ORL_OK ? NULL : json_pack(
        "{s:o, s:{s:I, s:I, s:I, s:I, s:I, s:I}, s:f, s:[[f,f,f],[f,f,f]], s:o, s:O*, s:O*, s:O*, s:O*, "
        "s:O*, s:O*, s:o, s:o}",
        "scene", orl_json_string(scene->dir), "counts", "photographs", (json_int_t)scene->photo_count, "train",
        (json_int_t)(scene->photo_count - test), "test", (json_int_t)test, "points",
        (json_int_t)orl_scene_point_count(scene), "silhouettes",
        (json_int_t)orl_scene_silhouettes(scene), "time_steps", (json_int_t)scene->frame_count,
        "photo_distance", scene->photo_distance, "bounds", low[0], low[1], low[2], high[0], high[1], high[2],
        "photographs", photos, "stages",
        json_object_get(manifest, "stages"), "settings", json_object_get(manifest, "settings"),
        "left_out", json_object_get(manifest, "left_out"), "tuned",
        json_object_get(manifest, "tuned"), "render",
        json_object_get(manifest, "render"), "origin", json_object_get(manifest, "origin"), "ground", orl_manifest_ground(&scene->ground),
        "backdrop", orl_manifest_backdrop(scene->backdrop_rests));
    json_decref(manifest);
    if (result != ORL_OK)
        json_decref(photos);
    if (!root && result == ORL_OK)
        orl_logf(log, ORL_LOG_ERROR, "no memory for the JSON text");
    return root;
}
