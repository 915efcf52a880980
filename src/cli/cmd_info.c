#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/summary.h"
#include "core/json.h"
#include "core/text.h"
#include "scene/manifest.h"

static bool same_camera(const struct orl_camera *a, const struct orl_camera *b)
{
    return a->width == b->width && a->height == b->height && a->fx == b->fx && a->fy == b->fy &&
           a->cx == b->cx && a->cy == b->cy;
}

static void print_cameras(const struct orl_scene *scene)
{
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_camera *camera = &scene->photos[i].view.camera;
        size_t users = 0;
        bool first = true;
        for (size_t k = 0; k < scene->photo_count; k++) {
            if (!same_camera(camera, &scene->photos[k].view.camera))
                continue;
            first = first && (users > 0 || k == i);
            users++;
        }
        if (first)
            printf("camera       %dx%d, focal length %.1f %.1f px, centre %.1f %.1f: %zu "
                   "photograph%s\n", camera->width, camera->height, camera->fx, camera->fy,
                   camera->cx, camera->cy, users, users == 1 ? "" : "s");
    }
}

static void print_photos(const struct orl_scene *scene)
{
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_photo *photo = &scene->photos[i];
        char shown[ORL_TEXT_SHOWN];
        orl_text_escape(photo->name, shown, sizeof shown);
        printf("%-5s %-32s %5dx%-5d", photo->test ? "test" : "train", shown,
               photo->view.camera.width, photo->view.camera.height);
        if (photo->has_exposure)
            printf("  %+.2f EV, series %d", photo->exposure_ev, photo->series);
        printf("\n");
    }
}

static void bounds(const struct orl_points *points, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++)
        low[k] = high[k] = (double)points->position[0][k];
    for (size_t i = 1; i < points->count; i++)
        for (int k = 0; k < 3; k++) {
            double v = (double)points->position[i][k];
            low[k] = v < low[k] ? v : low[k];
            high[k] = v > high[k] ? v : high[k];
        }
}

static json_t *photo_json(const struct orl_photo *photo)
{
    const struct orl_camera *c = &photo->view.camera;
    double centre[3];
    orl_pose_centre(&photo->view.cam_from_world, centre);
    return json_pack("{s:o, s:s, s:[i,i], s:[f,f], s:[f,f], s:[f,f,f], s:o, s:i}", "name",
                     orl_json_string(photo->name), "split", photo->test ? "test" : "train", "size", c->width,
                     c->height, "focal_px", c->fx, c->fy, "centre_px", c->cx, c->cy, "position",
                     centre[0], centre[1], centre[2], "exposure_ev",
                     photo->has_exposure ? json_real(photo->exposure_ev) : json_null(), "series",
                     photo->series);
}

static enum orl_result print_json(const struct orl_log *log, const struct orl_scene *scene)
{
    double low[3], high[3];
    size_t test = 0;
    json_t *photos = json_array(), *manifest = NULL;
    for (size_t i = 0; i < scene->photo_count; i++) {
        test += scene->photos[i].test;
        json_array_append_new(photos, photo_json(&scene->photos[i]));
    }
    bounds(&scene->points, low, high);
    char *path = orl_path_join(log, scene->dir, "scene.json");
    enum orl_result result = ORL_OK;
    if (path && orl_path_is_file(path))
        result = orl_json_read(log, path, &manifest);
    json_t *root = json_pack(
        "{s:o, s:{s:I, s:I, s:I, s:I}, s:f, s:[[f,f,f],[f,f,f]], s:o, s:O*, s:O*, s:O*, s:O*, s:o}",
        "scene", orl_json_string(scene->dir), "counts", "photographs", (json_int_t)scene->photo_count, "train",
        (json_int_t)(scene->photo_count - test), "test", (json_int_t)test, "points",
        (json_int_t)scene->points.count, "photo_distance", scene->photo_distance, "bounds",
        low[0], low[1], low[2], high[0], high[1], high[2], "photographs", photos, "stages",
        json_object_get(manifest, "stages"), "settings", json_object_get(manifest, "settings"),
        "left_out", json_object_get(manifest, "left_out"), "tuned",
        json_object_get(manifest, "tuned"), "ground", orl_manifest_ground(&scene->ground));
    char *text = root ? json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(9)) : NULL;
    if (text)
        printf("%s\n", text);
    else
        result = orl_fail(log, ORL_ERR_MEMORY, "no memory for the JSON text");
    free(text);
    free(path);
    json_decref(root);
    json_decref(manifest);
    return result;
}

static enum orl_result print_text(const struct orl_log *log, const struct orl_scene *scene)
{
    enum orl_result result = ORL_OK;
    char *path = orl_path_join(log, scene->dir, "scene.json");
    if (path && orl_path_is_file(path))
        result = summary_print(log, scene->dir);
    else
        printf("workspace    %s (COLMAP's, not prepared by Oriel)\n"
               "photographs  %zu\npoints       %zu\n", scene->dir, scene->photo_count,
               scene->points.count);
    free(path);
    double low[3], high[3];
    bounds(&scene->points, low, high);
    printf("bounds       %.4g %.4g %.4g to %.4g %.4g %.4g\n", low[0], low[1], low[2], high[0],
           high[1], high[2]);
    printf("distance     %.4g from photographs to what they see (median)\n",
           scene->photo_distance);
    if (scene->ground.height > 0)
        printf("ground       %.4g below the photographs, up is %.3f %.3f %.3f\n",
               scene->ground.height, scene->ground.plane[0], scene->ground.plane[1],
               scene->ground.plane[2]);
    for (size_t i = 0; i < scene->tuned_count; i++)
        printf("tuned        %s: %s=%.6g\n", scene->tuned[i].method, scene->tuned[i].key,
               scene->tuned[i].value);
    print_cameras(scene);
    print_photos(scene);
    return result;
}

struct options {
    bool json, check;
};

// Compares every file with the checksum that it had when it was made.
static enum orl_result check(const struct orl_log *log, const char *dir)
{
    size_t bad, files;
    enum orl_result result = orl_manifest_check(log, dir, &bad, &files);
    if (result != ORL_OK)
        return result;
    if (bad)
        return orl_fail(log, ORL_ERR_DATA,
                        "%s: %zu of %zu files are damaged; oriel prepare --resume makes them again",
                        dir, bad, files);
    printf("checked      %zu files, all as they were made\n", files);
    return ORL_OK;
}

static enum orl_result run(const struct terminal *terminal, const void *options,
                           const struct arg_common *common, const char *dir)
{
    (void)common;
    const struct options *o = options;
    struct orl_scene *scene = NULL;
    if (o->check)
        return check(&terminal->log, dir);
    enum orl_result result = orl_scene_open(&terminal->log, dir, &scene);
    if (result == ORL_OK)
        result = o->json ? print_json(&terminal->log, scene) : print_text(&terminal->log, scene);
    orl_scene_destroy(&scene);
    return result;
}

int cmd_info(int argc, char **argv)
{
    struct options o = {0};
    const struct arg_option options[] = {
        {"json", ARG_FLAG, &o.json, NULL, "as JSON", 0, 0},
        {"check", ARG_FLAG, &o.check, NULL, "compare all files with their checksums", 0, 0},
        {0},
    };
    const struct arg_command command = {
        "info", "SCENE [--json | --check]",
        "Says what is in a scene: photographs, cameras, points, and how it was made.", options, 1,
        1};
    return command_main(&command, argc, argv, run, &o);
}
