#include <jansson.h>
#include <stdio.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "core/file.h"
#include "core/text.h"
#include "oriel/render.h"
#include "scene/info.h"
#include "scene/manifest.h"

static void print_cameras(const struct orl_scene *scene)
{
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_camera *camera = &scene->photos[i].view.camera;
        size_t users = orl_scene_camera_users(scene, i);
        if (users)
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
        if (photo->occluded > 0)
            printf("  occluders on %.1f %%", 100 * (double)photo->occluded);
        printf("\n");
    }
}

static enum orl_result print_json(const struct orl_log *log, const struct orl_scene *scene)
{
    json_t *root = orl_scene_info(log, scene);
    return root ? report_write(log, "-", root) : ORL_ERR_FORMAT;
}

// How the scene is drawn unless a command says otherwise.
static void print_choices(const struct orl_scene *scene)
{
    const struct orl_scene_defaults *d = &scene->defaults;
    if (d->method || d->textures || d->depth_divide > 1 || d->depth_half)
        printf("drawn        by %s, textures %s, depth of photographs at 1/%d in %d bits\n",
               orl_method_default(scene), d->textures ? d->textures : orl_textures_names[0],
               d->depth_divide > 1 ? d->depth_divide : 1, d->depth_half ? 16 : 32);
    for (size_t i = 0; i < scene->tuned_count; i++) {
        const struct orl_tuned *tuned = &scene->tuned[i];
        printf("tuned        %s: %s=", tuned->method, tuned->key);
        if (tuned->name)
            printf("%s\n", tuned->name);
        else
            printf("%.6g\n", tuned->value);
    }
}

static enum orl_result print_text(const struct orl_log *log, const struct orl_scene *scene)
{
    enum orl_result result = ORL_OK;
    if (orl_path_is_file(ORL_PATH(scene->dir, "scene.json")))
        result = summary_print(log, scene->dir);
    else
        printf("workspace    %s (COLMAP's, not prepared by Oriel)\n"
               "photographs  %zu\npoints       %zu\n", scene->dir, scene->photo_count,
               scene->points.count);
    double low[3], high[3];
    orl_points_bounds(&scene->points, low, high);
    if (scene->points.count)
        printf("bounds       %.4g %.4g %.4g to %.4g %.4g %.4g\n", low[0], low[1], low[2], high[0],
               high[1], high[2]);
    printf("distance     %.4g from photographs to what they see (median)\n",
           scene->photo_distance);
    if (scene->ground.height > 0)
        printf("ground       %.4g below the photographs, up is %.3f %.3f %.3f\n",
               scene->ground.height, scene->ground.plane[0], scene->ground.plane[1],
               scene->ground.plane[2]);
    if (orl_scene_silhouettes(scene))
        printf("silhouettes  of %zu photographs\n", orl_scene_silhouettes(scene));
    if (scene->frame_count)
        printf("time steps   %zu\n", scene->frame_count);
    if (scene->backdrop_rests)
        printf("backdrop     rests in the photographs, as behind a turntable\n");
    print_choices(scene);
    print_cameras(scene);
    print_photos(scene);
    return result;
}

#define INFO_OPTIONS(ROW) \
    ROW(json, "json", FLAG, "as JSON") \
    ROW(check, "check", FLAG, "compare all files with their checksums")
COMMAND_OPTIONS(info_options, INFO_OPTIONS)

// Compares every file with the checksum from when it was made.
static enum orl_result check(const struct orl_log *log, const char *dir)
{
    size_t bad, files;
    ORL_TRY(orl_manifest_check(log, dir, &bad, &files));
    if (bad)
        return orl_fail(log, ORL_ERR_DATA, "%s: %zu of %zu files are damaged%s", dir, bad, files,
                        orl_path_is_file(ORL_PATH(dir, ".oriel/stages.json"))
                            ? "; oriel prepare --resume makes them again" : "");
    printf("checked      %zu files, all as they were made\n", files);
    return ORL_OK;
}

static enum orl_result run_info(struct call *call)
{
    const struct info_options *o = call->options;
    if (o->check && o->json)
        return orl_fail(call->log, ORL_ERR_ARGUMENT, "info: --json and --check exclude each other");
    if (o->check)
        return check(call->log, call->inputs[0]);
    ORL_TRY(command_scene(call, NULL));
    return o->json ? print_json(call->log, call->scene) : print_text(call->log, call->scene);
}

const struct command command_info = {
    .name = "info", .group = COMMAND_LOOK,
    .brief = "say what is in a scene",
    .usage = "SCENE [--json | --check]",
    .summary = "Says what is in a scene: photographs, cameras, points, and how it was made.",
    COMMAND_TABLE(info_options), .inputs_min = 1, .inputs_max = 1, .run = run_info,
};
